// SPDX-License-Identifier: Apache-2.0
#include "tools/program/command_line.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <iostream>
#include <sstream>
#include <vector>

#include "tools/program/run.h"

namespace palpate::program {
namespace {

bool read(CommandLine& line, std::initializer_list<const char*> words) {
  std::vector<const char*> argv{"program"};
  argv.insert(argv.end(), words);
  return line.read(static_cast<int>(argv.size()), argv.data());
}

std::string refusal(CommandLine& line, std::initializer_list<const char*> words) {
  try {
    (void)read(line, words);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

struct Values {
  std::string file, word{"press"}, at;
  double seconds{2.5};
  int steps{1};
  std::optional<double> radius;
  std::optional<std::int64_t> node;
  std::vector<int> pairs{20, 50};
  std::vector<std::string> more;
  bool json{false};
  std::optional<bool> lock;
};

// Options of every kind.
struct Example {
  CommandLine line{"program", "Shows what a command line can hold."};
  Values values;

  Example() {
    Options options = line.options();
    options.add("file", &values.file, "a file").required();
    options.add("--word", &values.word, "what to do").oneOf({"press", "slide"});
    options.add("--seconds", &values.seconds, "how long, s").range(0.5, 10.0, "s");
    options.add("--steps", &values.steps, "how many").range(1, 9);
    options.add("--radius", &values.radius, "how large").unit("m");
    options.add("--pairs", &values.pairs, "a list").list(',');
    options.add("--more", &values.more, "may be repeated").oneWordEach();
    options.flag("--json", &values.json, "for programs");
    options.flag("--lock,!--no-lock", &values.lock, "yes or no");
    Options where = options.exactlyOneOf("where");
    where.add("--at", &values.at, "x,y,z, m");
    where.add("--node", &values.node, "a number");
  }
};

TEST(CommandLine, FillsTheVariablesOfItsOptions) {
  Example example;
  ASSERT_TRUE(
      read(example.line, {"a.h5", "--at", "1,2,3", "--word", "slide", "--seconds=3", "--radius", "1e-3",
                          "--pairs", "1,2,3", "--more", "x", "--more", "y", "--json", "--no-lock"}));
  const Values& values = example.values;
  EXPECT_EQ(values.file, "a.h5");
  EXPECT_EQ(values.at, "1,2,3");
  EXPECT_EQ(values.word, "slide");
  EXPECT_EQ(values.seconds, 3.0);
  EXPECT_EQ(values.radius, 1e-3);
  EXPECT_EQ(values.pairs, (std::vector{1, 2, 3}));
  EXPECT_EQ(values.more, (std::vector<std::string>{"x", "y"}));
  EXPECT_TRUE(values.json);
  EXPECT_EQ(values.lock, false);
}

TEST(CommandLine, LeavesDefaultsWhereNothingIsSaid) {
  Example example;
  ASSERT_TRUE(read(example.line, {"a.h5", "--node", "7"}));
  EXPECT_EQ(example.values.seconds, 2.5);
  EXPECT_EQ(example.values.node, 7);
  EXPECT_FALSE(example.values.radius.has_value());
  EXPECT_FALSE(example.values.lock.has_value());
}

TEST(CommandLine, TakesNegativeNumbersAsValues) {
  for (const char* vector : {"-1,0,0", "-.1,0,0", "-0.5,-2,3"}) {
    Example example;
    ASSERT_TRUE(read(example.line, {"a.h5", "--at", vector}));
    EXPECT_EQ(example.values.at, vector);
  }
}

TEST(CommandLine, TakesASideAsAValue) {
  Example example;
  ASSERT_TRUE(read(example.line, {"a.h5", "--node", "1", "--more", "-x", "--more", "+z"}));
  EXPECT_EQ(example.values.more, (std::vector<std::string>{"-x", "+z"}));
}

TEST(CommandLine, LeavesTheNumberBehindAFlagAlone) {
  Example example;
  EXPECT_NE(refusal(example.line, {"a.h5", "--node", "1", "--json", "-5"}).find("-5"), std::string::npos);
}

TEST(CommandLine, RefusesByName) {
  const auto says = [](std::initializer_list<const char*> words, const char* expected) {
    Example example;
    EXPECT_NE(refusal(example.line, words).find(expected), std::string::npos) << refusal(example.line, words);
  };
  says({"--node", "1"}, "file is required");
  says({"a.h5", "--node", "1", "--word", "dance"}, "--word: dance not in {press,slide}");
  says({"a.h5", "--node", "1", "--steps", "10"}, "--steps: 10 is out of range, expected 1 to 9");
  says({"a.h5", "--node", "1", "--seconds", "0.1"}, "--seconds: 0.1 is out of range, expected 0.5 to 10 s");
  says({"a.h5", "--node", "1", "--seconds", "short"},
       "--seconds: short is not a number, expected 0.5 to 10 s");
  says({"a.h5", "--node", "1", "--steps", "2.5"}, "--steps: 2.5 is not a whole number, expected 1 to 9");
  says({"a.h5", "--node", "1", "--steps", "99999999999"}, "--steps: 99999999999 is out of range, expected 1");
  says({"a.h5", "--node", "1", "--radius", "wide"}, "--radius: wide is not a number, expected one in m");
  says({"a.h5", "--node", "one"}, "--node: one is not a number");
  says({"a.h5", "--node", "1.5"}, "--node: 1.5 is not a whole number in range");
  says({"a.h5"}, "--at,--node");
  says({"a.h5", "--node", "1", "--at", "1,2,3"}, "--at,--node");
  says({"a.h5", "--node", "1", "--colour"}, "--colour");
  says({"a.h5", "--node"}, "--node");
}

TEST(CommandLine, SuggestsTheOptionThatIsNearestBeforeItMissesAnything) {
  Example example;
  EXPECT_EQ(refusal(example.line, {"--secons", "3"}), "unknown option --secons: did you mean --seconds?");
  EXPECT_EQ(refusal(example.line, {"a.h5", "--nod=1"}), "unknown option --nod: did you mean --node?")
      << "of a group";
  EXPECT_EQ(refusal(example.line, {"--colour"}), "unknown option --colour (--help tells more)");
  EXPECT_EQ(refusal(example.line, {"--no-lokc"}), "unknown option --no-lokc: did you mean --no-lock?");
}

TEST(CommandLine, SuggestsASubcommandAndItsOptions) {
  const auto refused = [](std::initializer_list<const char*> words) {
    CommandLine line("program", "Does one thing or the other.");
    int count = 0, threads = 1;
    line.options().add("--threads", &threads, "how many");
    (void)line.options().subcommand("import", "the first");
    line.options().subcommand("other", "the second").add("--count", &count, "how many");
    return refusal(line, words);
  };
  EXPECT_EQ(refused({"imprt"}), "unknown subcommand imprt: did you mean import?");
  EXPECT_EQ(refused({"other", "--cuont", "3"}), "unknown option --cuont: did you mean --count?");
  EXPECT_EQ(refused({"--count", "3"}), "unknown option --count (--help tells more)")
      << "it is another subcommand's";
  EXPECT_EQ(refused({"--threads", "3", "other", "--count", "2"}), "accepted") << "3 is a value";
}

TEST(CommandLine, ReadsOneSubcommand) {
  CommandLine line("program", "Does one thing or the other.");
  int count = 0;
  const Options one = line.options().subcommand("one", "the first");
  Options other = line.options().subcommand("other", "the second");
  other.add("--count", &count, "how many");
  ASSERT_TRUE(read(line, {"other", "--count", "-3"}));
  EXPECT_FALSE(one.chosen());
  EXPECT_TRUE(other.chosen());
  EXPECT_EQ(count, -3);
  EXPECT_NE(refusal(line, {}).find("subcommand is required"), std::string::npos);
}

TEST(CommandLine, HelpShowsOptionsDefaultsAndRanges) {
  Example example;
  testing::internal::CaptureStdout();
  EXPECT_FALSE(read(example.line, {"--help"}));
  const std::string help = testing::internal::GetCapturedStdout();
  for (const char* text :
       {"Shows what a command line can hold.", "program [OPTIONS] file", "--word TEXT", "{press,slide}",
        "=press", "=2.5", "[0.5 - 10 s]", "[20,50]", "FLOAT:[m]", "Exit codes: 0 done, 1 failed, 2"})
    EXPECT_NE(help.find(text), std::string::npos) << text << " in\n" << help;
}

TEST(CommandLine, HelpHasAnExampleForEachSubcommand) {
  const auto help = [](std::initializer_list<const char*> words) {
    CommandLine line("program", "Does one thing or the other.");
    line.options().example("program one");
    line.options().subcommand("one", "the first").example("program one --count 3");
    testing::internal::CaptureStdout();
    EXPECT_FALSE(read(line, words));
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_NE(help({"--help"}).find("Example: program one\nExit codes:"), std::string::npos)
      << help({"--help"});
  EXPECT_NE(help({"one", "--help"}).find("Example: program one --count 3\nExit codes:"), std::string::npos);
}

TEST(CommandLine, SaysItsVersion) {
  Example example;
  testing::internal::CaptureStdout();
  EXPECT_FALSE(read(example.line, {"--version"}));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), std::string(PALPATE_VERSION) + "\n");
}

int fails(int, char**) {
  throw std::runtime_error("the disk is gone");
}

int refuses(int, char**) {
  throw UsageError("--colour is unknown");
}

TEST(RunProgram, TellsInOneLineWhatWentWrong) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(runProgram("palpate-x", &fails, 0, nullptr), 1);
  EXPECT_EQ(runProgram("palpate-x", &refuses, 0, nullptr), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "palpate-x: the disk is gone\npalpate-x: --colour is unknown\n");
}

}  // namespace
}  // namespace palpate::program
