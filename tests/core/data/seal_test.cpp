// SPDX-License-Identifier: Apache-2.0
// A model's copy in memory, when Linux is busy with its pages.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <string>

#include "core/data/load_error.h"
#include "core/data/sealed_image.h"
#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

namespace {

int busy = 0;           // how often sealing is refused from now on
int reason = 0;         // and why
std::size_t grown = 0;  // bytes that a file has more, for who reads it to its end

}  // namespace

/// In the place of the C library's: refuses seals as long as it is told to.
extern "C" int fcntl(int descriptor, int command, ...) {
  std::va_list arguments;
  va_start(arguments, command);
  const long argument = va_arg(arguments, long);
  va_end(arguments);
  if (command == F_ADD_SEALS && busy > 0) {
    --busy;
    errno = reason;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_fcntl, descriptor, command, argument));
}

/// In the place of the C library's: goes on at the end of a file that grew.
extern "C" ssize_t read(int descriptor, void* buffer, std::size_t size) {
  const ssize_t got = ::syscall(SYS_read, descriptor, buffer, size);
  if (got != 0 || grown == 0) return got;
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || status.st_size == 0) return got;  // as those of /proc
  const std::size_t more = std::min(size, grown);
  grown -= more;
  return static_cast<ssize_t>(more);
}

namespace palpate::testing {

class Seal : public ::testing::Test {
 protected:
  Seal() { modelfile::writeModel(file_.path(), syntheticModel({.subdivisions = 1, .modes = 2})); }
  ~Seal() override {
    busy = 0;
    grown = 0;
  }

  std::string complaint(int times, int why) {
    busy = times;
    reason = why;
    try {
      const SealedImage image(file_.path());
      EXPECT_LT(::write(image.descriptor(), "x", 1), 0);
      return {};
    } catch (const LoadError& error) {
      return error.what();
    }
  }

  TemporaryFile file_{"seal.h5"};
};

TEST_F(Seal, IsPutOnWhenThePagesAreNoLongerBusy) {
  EXPECT_EQ(complaint(0, EBUSY), "");
  EXPECT_EQ(complaint(5, EBUSY), "");
  EXPECT_EQ(busy, 0) << "it was not refused: does the test stand in the way of fcntl?";
}

TEST_F(Seal, ThatCannotBePutOnIsAnErrorWithItsReason) {
  EXPECT_NE(complaint(1000, EBUSY).find("cannot be sealed: Device or resource busy"), std::string::npos);
  EXPECT_NE(complaint(1, EPERM).find("cannot be sealed: Operation not permitted"), std::string::npos);
}

TEST_F(Seal, OfAFileThatGrowsIsNotAwaited) {
  constexpr std::size_t kMuch = 64U << 20U;
  grown = kMuch;
  EXPECT_NE(complaint(0, EBUSY).find("gave more than "), std::string::npos);
  EXPECT_GT(grown, kMuch / 2) << "the rest was not copied";
}

TEST_F(Seal, AnOpenFileIsCopiedLikeANamedOne) {
  const int file = ::open(file_.path().c_str(), O_RDONLY);
  ASSERT_GE(file, 0);
  const SealedImage image(file, "model.h5");
  EXPECT_EQ(image.bytes().size(), std::filesystem::file_size(file_.path()));
  EXPECT_EQ(::close(file), 0) << "it was borrowed";
}

}  // namespace palpate::testing
