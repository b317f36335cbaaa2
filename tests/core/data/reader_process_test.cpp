// SPDX-License-Identifier: Apache-2.0
// The process that parses model files, where it crashes, hangs or says too much: shell scripts take its place.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>

#include "../load_case.h"
#include "core/data/ask_reader.h"
#include "core/data/model_answer.h"
#include "core/data/sealed_image.h"

namespace palpate::testing {

namespace {

using std::chrono::milliseconds;

class ReaderProcessTest : public ::testing::Test {
 protected:
  ReaderProcessTest() { modelfile::writeModel(folder_ / "model.h5", goodData()); }

  /// What is said where a script parses the file; empty: nothing.
  std::string complaintOf(const std::string& script, ReaderProcess process = {}) {
    process.program = folder_.write("reader", "#!/bin/sh\n" + script + "\n");
    ::chmod(process.program.c_str(), 0700);
    return complaintTo(process);
  }
  std::string complaintTo(const ReaderProcess& process) {
    try {
      (void)MetaModel::load(image(), "model.h5", process);
      return {};
    } catch (const LoadError& error) {
      return error.what();
    }
  }
  [[nodiscard]] std::shared_ptr<const SealedImage> image() const {
    return std::make_shared<const SealedImage>(folder_ / "model.h5");
  }
  /// A file with an answer.
  std::string written(const std::string& answer) { return folder_.write("answer", answer).string(); }

  const TemporaryFolder folder_;
};

std::string theReader() {
  return readerOf(std::filesystem::read_symlink("/proc/self/exe")).value_or("").string();
}

std::string ended(const std::string& how) {
  return "model.h5: the process that parses it ended " + how + ", the file is damaged or made to harm";
}

std::string disbelieved(const std::string& what) {
  return "model.h5: the answer of the process that parses it is not to be believed: " + what;
}

}  // namespace

TEST_F(ReaderProcessTest, TheRealOneIsFound) {
  EXPECT_EQ(complaintTo({}), "");
}

TEST_F(ReaderProcessTest, HowItEndedIsSaid) {
  EXPECT_EQ(complaintOf("kill -SEGV $$"), ended("by Segmentation fault"));
  EXPECT_EQ(complaintOf("kill -SYS $$"), ended("by Bad system call"));
  EXPECT_EQ(complaintOf("kill -XCPU $$"), ended("by CPU time limit exceeded"));
  EXPECT_EQ(complaintOf("exit 3"), ended("with exit code 3"));
  EXPECT_EQ(complaintOf("/bin/cat " + written(askReader(*image(), "model.h5")) + "; kill -SEGV $$"),
            ended("by Segmentation fault"))
      << "whatever it said before";
  EXPECT_EQ(complaintTo({.program = "/nowhere/reader"}),
            "model.h5: no process can be started to parse it, /nowhere/reader: No such file or directory");
}

/// cat closes its output some time before its end.
TEST_F(ReaderProcessTest, HasTimeToEndBehindItsAnswer) {
  const std::string answer = written(askReader(*image(), "model.h5"));
  for (int time = 0; time < 20; ++time) ASSERT_EQ(complaintOf("exec /bin/cat " + answer), "") << time;
  EXPECT_EQ(complaintOf("/bin/cat " + answer + "; exec >&-; /bin/sleep 0.2"), "");
  EXPECT_LT(::waitpid(-1, nullptr, WNOHANG), 0) << "none is left";
}

TEST_F(ReaderProcessTest, WhereItCannotRunTheFileIsNotBlamed) {
  const std::string cannot = "model.h5: palpate-read-model cannot run here, ";
  EXPECT_EQ(complaintOf("exit 127"), cannot + "one of its libraries is missing or has no room (ulimit -v)");
  EXPECT_EQ(complaintOf("exec " + theReader() + " <&-"),
            cannot + "the file's copy cannot be mapped (ulimit -v)");
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(complaintTo({}), cannot + "this program does not hear how it ends: SIGCHLD is ignored");
  std::signal(SIGCHLD, before);
}

/// Never relative: that would be a program in whatever folder a program was started in.
TEST_F(ReaderProcessTest, IsLookedForWhereTheProgramIs) {
  const auto in = [&](const char* folder) { return readerOf(folder_ / folder / "program"); };
  EXPECT_EQ(in("bin"), (folder_ / "bin" / PALPATE_READER_FROM_BIN / "palpate-read-model").lexically_normal());
  std::filesystem::create_directories(folder_ / "bin");
  (void)folder_.write("bin/palpate-read-model", "");
  EXPECT_EQ(in("bin"), folder_ / "bin/palpate-read-model");
  EXPECT_EQ(in("tests"), folder_ / "bin/palpate-read-model");
  EXPECT_EQ(readerOf(""), std::nullopt);
  EXPECT_EQ(readerOf("bin/program"), std::nullopt);
}

TEST_F(ReaderProcessTest, IsNotWaitedForWithoutEnd) {
  const auto before = std::chrono::steady_clock::now();
  const std::string late =
      "model.h5: the process that parses it was not done in 200 ms, the file is made to harm or the "
      "machine is too busy";
  EXPECT_EQ(complaintOf("exec /bin/sleep 600", {.most = milliseconds(200)}), late);
  EXPECT_EQ(complaintOf("kill -STOP $$", {.most = milliseconds(200)}), late);
  EXPECT_EQ(complaintOf("while :; do echo; /bin/sleep 0.01; done", {.most = milliseconds(200)}), late);
  const std::atomic<bool> given_up{true};
  EXPECT_EQ(complaintOf("exec /bin/sleep 600", {.given_up = &given_up}),
            "model.h5: nobody wants it any more");
  EXPECT_EQ(complaintOf("exec /bin/sleep 600 >&-", {.most = milliseconds(200)}), late);
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(20));
  EXPECT_LT(::waitpid(-1, nullptr, WNOHANG), 0) << "none is left";
}

TEST_F(ReaderProcessTest, AnEndlessAnswerIsNotHeardToItsEnd) {
  EXPECT_EQ(complaintOf("exec /bin/cat /dev/zero"),
            "model.h5: the process that parses it says more than 8 MiB, the file is made to harm");
  EXPECT_LT(::waitpid(-1, nullptr, WNOHANG), 0) << "none is left";
}

TEST_F(ReaderProcessTest, ARefusalIsOneShortLine) {
  const std::string refusal = "is " + std::string(5000, 'x') + "\n\x1b[2J";
  const std::string said = complaintOf("/bin/cat " + written(ModelAnswer::refusal(refusal)));
  EXPECT_EQ(said, "model.h5: is " + std::string(997, 'x'));
  EXPECT_EQ(complaintOf("/bin/cat " + written(ModelAnswer::refusal("two\nlines"))), "model.h5: two?lines");
  const std::string turned = "\u202egnp\u009b2J\xff";
  EXPECT_EQ(complaintOf("/bin/cat " + written(ModelAnswer::refusal(turned))), "model.h5: ???gnp??2J?")
      << "letters that a terminal obeys, or cannot show";
}

TEST_F(ReaderProcessTest, ADamagedAnswerIsNotBelieved) {
  const std::string answer = askReader(*image(), "model.h5");
  const std::string other = disbelieved("it is not that of this version of palpate-read-model");
  EXPECT_EQ(complaintOf("/bin/cat " + written(answer)), "");
  EXPECT_EQ(complaintOf("exit 0"), other);
  EXPECT_EQ(complaintOf("/bin/cat " + written(answer.substr(0, answer.size() / 2))),
            disbelieved("it ends too early"));
  EXPECT_EQ(complaintOf("/bin/cat " + written(answer + "E")), disbelieved("it goes on behind its end"));
}

/// 3 of its input, output and errors are all: no socket of a server, no variable that HDF5 obeys, no signal that is blocked.
TEST_F(ReaderProcessTest, InheritsNothing) {
  const int open = ::fcntl(STDERR_FILENO, F_DUPFD, 100);
  ::setenv("HDF5_PLUGIN_PATH", "/tmp", 1);
  sigset_t term, before;
  ::sigemptyset(&term);
  ::sigaddset(&term, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &term, &before);
  const std::string file = "/proc/$$/fd/" + std::to_string(open);
  EXPECT_EQ(complaintOf("[ ! -e " + file + " ] || exit 3\n[ -z \"${HDF5_PLUGIN_PATH+set}\" ] || exit 4\n" +
                        "echo noise >&2\nkill -TERM $$"),
            ended("by Terminated"));
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ::unsetenv("HDF5_PLUGIN_PATH");
  ::close(open);
}

}  // namespace palpate::testing
