// SPDX-License-Identifier: Apache-2.0
// What a journal gives back after a program was killed: every part that was kept whole, and nothing else.
#include "tools/solver/base/journal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <vector>

#include "tools/solver/base/checkpoint.h"

namespace palpate::solver {
namespace {

namespace fs = std::filesystem;

class Kept : public ::testing::Test {
 protected:
  Kept() { fs::create_directory(folder_); }
  ~Kept() override { fs::remove_all(folder_); }

  /// Keeps three parts of 8 numbers each; part k holds k.
  void keepThree() const {
    Journal journal(file_);
    for (std::uint8_t part = 0; part < 3; ++part) journal.keep(part, record::Bytes(8, part), 0.5);
  }
  [[nodiscard]] std::vector<bool> found() const {
    const Journal journal(file_);
    std::vector<bool> out;
    for (std::uint8_t part = 0; part < 3; ++part) {
      const auto kept = journal.find(part);
      if (kept) {
        EXPECT_EQ(*kept, record::Bytes(8, part));
      }
      out.push_back(kept.has_value());
    }
    return out;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("palpate-journal-" + std::to_string(getpid()));
  const fs::path file_ = folder_ / "stage.journal";
};

TEST_F(Kept, IsGivenBackWithTheTimeThatItTook) {
  keepThree();
  EXPECT_EQ(found(), std::vector<bool>({true, true, true}));
  const Journal journal(file_);
  EXPECT_EQ(journal.found(), 0.0) << "nobody has asked yet";
  (void)journal.find(1);
  EXPECT_EQ(journal.found(), 0.0) << "nobody could use it yet";
  journal.taken(0);
  journal.taken(2);
  EXPECT_DOUBLE_EQ(journal.found(), 1.0);
  EXPECT_FALSE(journal.find(3));
}

TEST_F(Kept, EndsWhereTheLastRecordIsNotWhole) {
  keepThree();
  fs::resize_file(file_, fs::file_size(file_) - 1);
  EXPECT_EQ(found(), std::vector<bool>({true, true, false}));
  Journal(file_).keep(2, record::Bytes(8, 2), 0.5);
  EXPECT_EQ(found(), std::vector<bool>({true, true, true})) << "written in the place of what was torn";
}

TEST_F(Kept, EndsWhereAByteIsWrong) {
  keepThree();
  const auto size = static_cast<std::streamoff>(fs::file_size(file_));
  for (const std::streamoff at : {size / 3 + 3, size / 3 + 20, 2 * size / 3 - 1}) {
    fs::remove(file_);
    keepThree();
    std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(at);
    const char changed = static_cast<char>(file.get() ^ 0x10);
    file.seekp(at);
    file.put(changed);
    file.close();
    EXPECT_EQ(found(), std::vector<bool>({true, false, false})) << "byte " << at;
  }
}

TEST_F(Kept, PartsAreNotDoneAgain) {
  std::atomic<int> done{0}, restored{0};
  const auto run = [&] {
    Journal journal(file_);
    parallelParts(
        2, 7, &journal,
        [&](std::size_t part, record::ByteSource& kept) {
          if (kept.get<std::uint64_t>() != part || part == 5) throw record::RecordError("spoiled");
          ++restored;
        },
        [&](int, std::size_t part) {
          ++done;
          record::Bytes kept;
          record::put(kept, static_cast<std::uint64_t>(part));
          return kept;
        });
  };
  run();
  EXPECT_EQ(done, 7);
  EXPECT_EQ(restored, 0);
  run();
  EXPECT_EQ(done, 8) << "the one that could not be restored";
  EXPECT_EQ(restored, 6);
}

TEST_F(Kept, BelongsToOneSolve) {
  const fs::path folder = folder_ / "model.h5.partial";
  const std::vector<std::string> soft{"material.E = 1000", "model.order = 3"}, stiff{"material.E = 2000"};
  {
    Checkpoint checkpoint(folder, soft, false);
    EXPECT_FALSE(checkpoint.goesOn());
    checkpoint.journal("series").keep(0, record::Bytes(8), 1.0);
    EXPECT_THROW(Checkpoint(folder, soft, false), CheckpointError) << "in use";
  }
  try {
    const Checkpoint other(folder, stiff, false);
    ADD_FAILURE() << "taken for another solve";
  } catch (const CheckpointError& error) {
    EXPECT_NE(std::string(error.what()).find("material.E is now 2000, was 1000"), std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(Checkpoint(folder, soft, false).goesOn());
  EXPECT_FALSE(Checkpoint(folder, stiff, true).goesOn());
  EXPECT_FALSE(fs::exists(folder)) << "nothing was done in it";
}

TEST_F(Kept, IsGoneOnceAndForAll) {
  const fs::path folder = folder_ / "model.h5.partial";
  const std::vector<std::string> solve{"material.E = 1000"};
  Checkpoint done(folder, solve, false);
  done.journal("series").keep(0, record::Bytes(8), 1.0);
  done.remove();
  EXPECT_FALSE(fs::exists(folder));
  Checkpoint next(folder, solve, false);  // of a program that begins while the first one ends
  EXPECT_FALSE(next.goesOn());
  done.remove();
  EXPECT_TRUE(fs::exists(folder)) << "the next one's";
}

TEST_F(Kept, GoesOnWhenItWasKilledWhileItWent) {
  const fs::path folder = folder_ / "model.h5.partial";
  const std::vector<std::string> solve{"material.E = 1000"};
  { Checkpoint(folder, solve, false).journal("series").keep(0, record::Bytes(8), 1.0); }
  ASSERT_TRUE(fs::exists(folder));
  fs::remove(folder / "series.journal");  // the first of what goes
  EXPECT_FALSE(Checkpoint(folder, solve, false).goesOn());
}

TEST_F(Kept, LeavesOthersFoldersAlone) {
  const fs::path folder = folder_ / "model.h5.partial";
  fs::create_directory(folder);
  std::ofstream(folder / "thesis.tex") << "years of work";
  EXPECT_THROW(Checkpoint(folder, std::vector<std::string>{"a = b"}, true), CheckpointError);
  EXPECT_TRUE(fs::exists(folder / "thesis.tex"));
  EXPECT_FALSE(fs::exists(folder / "solve"));
  std::ofstream(folder / "solve") << "x = 3\n";
  EXPECT_THROW(Checkpoint(folder, std::vector<std::string>{"a = b"}, true), CheckpointError);
  EXPECT_TRUE(fs::exists(folder / "thesis.tex")) << "a file of that name is not enough";
}

}  // namespace
}  // namespace palpate::solver
