// SPDX-License-Identifier: Apache-2.0
// palpate-read-model itself, as programs start it: what it has given up when it parses, and files that take too much memory.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "../load_case.h"
#include "core/data/ask_reader.h"
#include "core/data/descriptor.h"
#include "core/data/load_error.h"
#include "core/data/model_answer.h"
#include "core/data/sealed_image.h"

namespace palpate::testing {

namespace {

std::string contentOfProcess(pid_t process, const char* file) {
  std::stringstream content;
  content << std::ifstream("/proc/" + std::to_string(process) + "/" + file).rdbuf();
  return content.str();
}

/// The words behind the first in a line of /proc/PID/status or limits: "Seccomp:", "2"; without units.
std::vector<std::string> wordsBehind(const std::string& content, const std::string& first) {
  const std::size_t at = content.find("\n" + first);
  std::istringstream line(at == std::string::npos ? "" : content.substr(at + 1 + first.size()));
  std::string text, word;
  std::getline(line, text);
  std::istringstream words(text);
  std::vector<std::string> found;
  while (words >> word) found.push_back(word);
  return found;
}

/// Its two ends; a program waits that writes into it.
std::pair<Descriptor, Descriptor> fullPipe() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK), 0);
  while (::write(ends[1], "x", 1) == 1) continue;
  ::fcntl(ends[1], F_SETFL, 0);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// A program that parses a good model, and cannot say what it found, since its output is full.
class HeldReader {
 public:
  HeldReader() {
    const TemporaryFile file("model.h5");
    modelfile::writeModel(file.path(), goodData());
    const SealedImage image(file.path());
    const std::string program = readerOf(std::filesystem::read_symlink("/proc/self/exe")).value().string();
    id_ = ::fork();
    if (id_ != 0) return;
    const rlimit seconds{7, RLIM_INFINITY};
    ::setrlimit(RLIMIT_CPU, &seconds);
    ::dup2(image.descriptor(), STDIN_FILENO);
    ::dup2(output_.second.get(), STDOUT_FILENO);
    ::execl(program.c_str(), program.c_str(), nullptr);
    ::_exit(1);
  }
  HeldReader(const HeldReader&) = delete;
  HeldReader& operator=(const HeldReader&) = delete;
  ~HeldReader() {
    if (id_ < 0) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
  }

  /// Waits until it is locked down, or holds without that.
  [[nodiscard]] std::string status() const {
    std::string status;
    for (int look = 0; look < 500; ++look) {
      status = contentOfProcess(id_, "status");
      if (wordsBehind(status, "Seccomp:") == std::vector<std::string>{"2"}) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return status;
  }
  [[nodiscard]] std::string limits() const { return contentOfProcess(id_, "limits"); }

 private:
  std::pair<Descriptor, Descriptor> output_{fullPipe()};
  pid_t id_{-1};
};

using Words = std::vector<std::string>;

}  // namespace

TEST(ReaderProgram, HasGivenUpEverythingWhenItParses) {
  const HeldReader reader;
  const std::string status = reader.status();
  EXPECT_EQ(wordsBehind(status, "Seccomp:"), Words{"2"}) << status;
  EXPECT_EQ(wordsBehind(status, "NoNewPrivs:"), Words{"1"});
  const std::string limits = reader.limits();
  EXPECT_EQ(wordsBehind(limits, "Max cpu time"), (Words{"7", "11", "seconds"}))
      << "what is lower already stays; SIGXCPU before SIGKILL";
  EXPECT_EQ(wordsBehind(limits, "Max core file size"), (Words{"0", "0", "bytes"}));
  EXPECT_EQ(wordsBehind(limits, "Max file size"), (Words{"0", "0", "bytes"}));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their runtimes take all
  EXPECT_EQ(wordsBehind(limits, "Max open files"), (Words{"0", "0", "files"}));
  const Words addresses = wordsBehind(limits, "Max address space");
  ASSERT_EQ(addresses.size(), 3U) << limits;
  ASSERT_NE(addresses[1], "unlimited");
  EXPECT_LT(std::stoull(addresses[1]), std::uint64_t{1} << 30U);
#endif
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
std::string complaintOfText(std::size_t bytes) {
  const TemporaryFile file("long.h5");
  modelfile::ModelData data = goodData();
  data.attributes.provenance = std::string(bytes, 'x');
  modelfile::writeModel(file.path(), data);
  const SealedImage image(file.path());
  try {
    const AnsweredModel model(image, "long.h5", askReader(image, "long.h5"));
    return {};
  } catch (const LoadError& error) {
    return error.what();
  }
}

/// HDF5 and the answer hold it several times at once.
TEST(ReaderProgram, ATextOfMoreThan7MiBIsRefusedForWhatItTakes) {
  constexpr std::size_t kMiB = 1U << 20U;
  EXPECT_EQ(complaintOfText(7 * kMiB), "");
  EXPECT_EQ(complaintOfText(8 * kMiB),
            "long.h5: the process that parses it says more than 8 MiB, the file is made to harm");
  EXPECT_EQ(complaintOfText(10 * kMiB),
            "long.h5: takes more to parse than 64 MiB of memory, or than ulimit -v leaves");
}
#endif

}  // namespace palpate::testing
