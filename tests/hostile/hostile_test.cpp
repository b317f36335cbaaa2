// SPDX-License-Identifier: Apache-2.0
// A server among programs that do everything wrong, and a tool that behaves all the while. All of them but the server are made
// from palpate.idl alone, with DDS's default QoS.
#include <gtest/gtest.h>

#include <csignal>
#include <iostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "palpate/testing/child_process.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::testing {
namespace {

constexpr const char* kForceLimit = "3.3";
// Where a tip of 5 mm touches the synthetic organ's top.
const std::vector<std::string> kTouch{"0", "0", "0.055"};

std::string program(const char* name) {
  return std::string(PALPATE_TEST_PROGRAMS "/") + name;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

class Hostility : public ::testing::Test {
 protected:
  Hostility() { writeSyntheticModel(model_.path()); }

  [[nodiscard]] std::vector<std::string> arguments(std::vector<std::string> before) const {
    before.insert(before.begin(), domain_);
    before.insert(before.end(), kTouch.begin(), kTouch.end());
    return before;
  }

  // Each kind of wrong in turn, while the tool that behaves plays for `seconds`, up to four times. A second that lacks
  // answers is the machine's, unless one within a second of it lacks them each time, or more than a tenth do in all
  // plays but one. Where more do without anybody who does wrong too, it cannot be judged.
  void playAndJudge(double each, int seconds) {
    const std::size_t many = static_cast<std::size_t>(seconds) / 10;
    std::set<int> lacking = play(each, seconds);
    std::size_t good = lacking.size() <= many ? 1 : 0;
    const auto holds = [&] { return lacking.empty() && good >= 2; };
    if (lacking.empty()) return;
    for (int again = 0; again < 3 && !holds() && !HasFailure(); ++again) {
      const std::set<int> others = play(each, seconds);
      good += others.size() <= many ? 1 : 0;
      std::erase_if(lacking, [&](int second) {
        return !others.contains(second - 1) && !others.contains(second) && !others.contains(second + 1);
      });
    }
    if (HasFailure()) return;
    if (!holds())
      if (const std::size_t alone = play(0.0, seconds).size(); alone > many)
        GTEST_SKIP() << "the machine keeps a tool from its answers in " << alone << " of " << seconds << " s";
    if (!lacking.empty()) ADD_FAILURE() << "about second " << *lacking.begin() << " of each play";
    EXPECT_GE(good, 2U) << "plays in which at most a tenth of the seconds lacks answers";
  }

 private:
  // @param[in] each  s of each kind of wrong; 0: of none
  // @return the seconds in which fewer than 900 answers came
  std::set<int> play(double each, int seconds) {
    ServerProcess server(
        {"--model", model_.path().string(), "--domain", domain_, "--device", "touch", "--tools", "2"});
    const CaughtOutput report;
    auto good = arguments({std::to_string(seconds)});
    good.push_back(kForceLimit);
    ChildProcess tool(program("well_behaved_peer"), good, {.out = report.descriptor()});
    if (each > 0.0) {
      const auto hostile = runProgram(program("hostile_peer"), arguments({"all", std::to_string(each)}));
      EXPECT_EQ(hostile.exit_code, 0);
      EXPECT_EQ(linesOf(hostile.out).size(), 34U) << hostile.out;
      EXPECT_TRUE(tool.running()) << "it was to behave longer than the others did not";
    }
    EXPECT_EQ(tool.waitForExit(std::chrono::seconds(2 * seconds)), 0) << report.text();
    EXPECT_TRUE(server.running()) << server.log();
    server.signal(SIGTERM);
    EXPECT_EQ(server.waitForExit(), 0) << server.log();
    const std::set<int> lacking = lackingOf(report.text());
    if (!lacking.empty()) std::cout << "answers are lacking:\n" << report.text() << server.log();
    return lacking;
  }

  static std::set<int> lackingOf(const std::string& report) {
    std::set<int> lacking;
    for (const std::string& line : linesOf(report)) {
      int second = 0, answers = 0, in_contact = 0;
      if (std::sscanf(line.c_str(), "%d answers %d", &second, &answers) == 2) {
        if (answers < 900) lacking.insert(second);
      } else if (std::sscanf(line.c_str(), "largest %*f N, in contact %d", &in_contact) == 1) {
        EXPECT_GT(in_contact, 1000) << report;
      }
    }
    return lacking;
  }

  std::string domain_ = std::to_string(exclusiveDomain());
  TemporaryFile model_{"hostile.h5"};
};

TEST_F(Hostility, TouchesNoToolThatBehaves) {
  playAndJudge(0.3, 20);
}

class LongHostility : public Hostility {};

TEST_F(LongHostility, TouchesNoToolThatBehaves) {
  playAndJudge(1.0, 50);
}

}  // namespace
}  // namespace palpate::testing
