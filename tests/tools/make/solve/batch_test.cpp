// SPDX-License-Identifier: Apache-2.0
// palpate-solve --batch: a folder of cases.
#include "core/model/meta_model.h"
#include "solved_in_batches.h"
#include "tools/modelfile/scale_model.h"

namespace palpate {
namespace {

TEST_F(SolvedInBatches, HaveTheModelsOfSingleSolves) {
  addCase("linear.toml", "[model]\nmethod = \"pgd-linear\"\nmodes = 20\n");
  addCase("soft.toml", quick_ + "[material]\nE = 1e4\n");
  addCase("stiff.toml", quick_);
  std::ofstream(inCases(".stiff.toml")) << "what an editor left";
  const json report = solved(0);
  EXPECT_EQ(statesOf(report),
            (States{{"linear.toml", "solved"}, {"soft.toml", "solved"}, {"stiff.toml", "solved"}}));
  EXPECT_EQ(report.at("solved"), 3);
  EXPECT_FALSE(report.contains("estimated"));
  EXPECT_EQ(leftOvers(), std::vector<std::string>());
  for (const std::string name : {"linear", "soft", "stiff"}) {
    const ProgramResult single =
        solve({inCases(name + ".toml"), "-o", path(name + ".h5"), "--json", "-q", "--threads", "1"});
    ASSERT_EQ(single.exit_code, 0) << single.err;
    EXPECT_EQ(digest("cases/" + name + ".h5"), digest(name + ".h5"));
    EXPECT_TRUE(fs::exists(inCases(name + ".xdmf")));
    EXPECT_EQ(entryOf(report, name + ".toml").at("solve").at("modes"), json::parse(single.out).at("modes"));
  }
}

TEST_F(SolvedInBatches, AreLeftUntilTheirCaseOrMeshChanges) {
  addCase("one.toml", quick_);
  addCase("two.toml", quick_);
  ASSERT_EQ(solved(0).at("solved"), 2);
  const auto written = fs::last_write_time(inCases("one.h5"));
  EXPECT_EQ(solved(0).at("there"), 2);
  addCase("two.toml", quick_ + "# a comment changes nothing\n");
  EXPECT_EQ(solved(0).at("there"), 2);
  addCase("two.toml", quick_ + "[material]\nE = 150e3\n");
  const json changed = solved(0);
  EXPECT_EQ(statesOf(changed), (States{{"one.toml", "there"}, {"two.toml", "solved"}}));
  EXPECT_EQ(entryOf(changed, "two.toml").at("again"), "material.E is now 150000, was 160000");
  EXPECT_EQ(fs::last_write_time(inCases("one.h5")), written);
  EXPECT_EQ(solved(0, {"--force-error", "0.02"}).at("solved"), 2) << "the command line is the case's too";
  std::ofstream(folder_ / "block.msh", std::ios::app) << "$Comments\nanother mesh\n$EndComments\n";
  const json again = solved(0, {"--force-error", "0.02"});
  EXPECT_EQ(again.at("solved"), 2);
  EXPECT_EQ(entryOf(again, "one.toml").at("again").get<std::string>().rfind("mesh is now SHA-256", 0), 0U);
}

TEST_F(SolvedInBatches, GoOnAfterOneThatFails) {
  addCase("a_key.toml", "[material]\nF = 1e4\n");
  std::ofstream(inCases("b_mesh.toml")) << "mesh = \"none.msh\"\n";
  addCase("c_good.toml", quick_);
  addCase("d_group.toml", quick_ + "[boundary]\nfixed = \"rim\"\n");
  const ProgramResult result = solve(batch());
  EXPECT_EQ(result.exit_code, 1);
  const json report = json::parse(result.out);
  EXPECT_EQ(statesOf(report), (States{{"a_key.toml", "failed"},
                                      {"b_mesh.toml", "failed"},
                                      {"c_good.toml", "solved"},
                                      {"d_group.toml", "failed"}}));
  for (const auto& [name, part] : States{{"a_key.toml", "a_key.toml:3: "},
                                         {"b_mesh.toml", "none.msh: cannot be opened for reading"},
                                         {"d_group.toml", "rim"}}) {
    const auto error = entryOf(report, name).at("error").get<std::string>();
    EXPECT_NE(error.find(part), std::string::npos) << error;
    const std::size_t told = result.err.find("error: " + name + ": " + error + '\n');
    ASSERT_NE(told, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find(error, told + error.size() + name.size()), std::string::npos) << result.err;
  }
  EXPECT_NE(result.err.find("1 solved, 3 failed; "), std::string::npos) << result.err;
}

TEST_F(SolvedInBatches, DoNotReplaceWhatTheyDidNotMake) {
  addCase("fitted.toml", quick_);
  addCase("thesis.toml", quick_);
  addCase("slides.toml", quick_);
  for (const char* const file : {"thesis.h5", "slides.xdmf", "fitted.h5.lock"})
    std::ofstream(inCases(file)) << "years of work";
  const json first = solved(1);
  EXPECT_EQ(statesOf(first),
            (States{{"fitted.toml", "solved"}, {"slides.toml", "failed"}, {"thesis.toml", "failed"}}));
  EXPECT_EQ(
      entryOf(first, "slides.toml").at("error"),
      inCases("slides.xdmf").string() + " is in the way: it does not belong to slides.h5; move it away");
  for (const char* const file : {"thesis.h5", "slides.xdmf", "fitted.h5.lock"})
    EXPECT_EQ(testing::contentOf(inCases(file)), "years of work") << file;
  fs::remove(inCases("slides.xdmf"));
  ASSERT_EQ(solved(1).at("solved"), 1);
  fs::remove(inCases("slides.h5"));
  ASSERT_EQ(solved(1).at("solved"), 1) << "its own .xdmf is not in the way";
  {
    const MetaModel model = MetaModel::load(inCases("fitted.h5"));
    json provenance = json::parse(model.attributes().provenance);
    provenance["fitted"] = {{"program", "palpate-fit"}};
    modelfile::writeScaled(path("fitted.h5"), model, 2e5, provenance.dump());
  }
  fs::rename(path("fitted.h5"), inCases("fitted.h5"));
  const std::string content = testing::contentOf(inCases("fitted.h5"));
  const json report = solved(1);
  EXPECT_EQ(report.at("failed"), 2);
  const auto error = entryOf(report, "fitted.toml").at("error").get<std::string>();
  EXPECT_NE(error.find("fitted.h5 is in the way: "), std::string::npos) << error;
  EXPECT_EQ(testing::contentOf(inCases("fitted.h5")), content);
}

TEST_F(SolvedInBatches, BeginAgainFromAnotherCaseOnlyWhenAsked) {
  addCase("one.toml", slow_);
  {
    testing::ChildProcess program("palpate-solve", batch(), {});
    ASSERT_GT(solverOf(program, inCases("one.h5")), 0);
    program.signal(SIGKILL);
    ASSERT_EQ(program.waitForExit(), 128 + SIGKILL);
  }
  addCase("one.toml", slow_ + "[material]\nE = 150e3\n");
  addCase("two.toml", "[model]\nmethod = \"pgd-linear\"\nmodes = 20\n");
  const json refused = solved(1);
  EXPECT_EQ(statesOf(refused), (States{{"one.toml", "failed"}, {"two.toml", "solved"}}));
  const auto error = entryOf(refused, "one.toml").at("error").get<std::string>();
  EXPECT_NE(error.find("material.E is now 150000, was 160000; --fresh begins again"), std::string::npos)
      << error;
  EXPECT_EQ(statesOf(solved(0, {"--fresh"})), (States{{"one.toml", "solved"}, {"two.toml", "there"}}));
}

TEST_F(SolvedInBatches, SayWhatTheyWouldTake) {
  addCase("linear.toml", "[model]\nmethod = \"pgd-linear\"\n");
  addCase("one.toml", quick_);
  addCase("two.toml", quick_ + "[material]\nE = 1e5\n");
  const json report = solved(1, {"--dry-run", "-o", path("models")});
  EXPECT_EQ(report.at("dry_run"), true);
  EXPECT_EQ(report.at("estimated"), 2);
  EXPECT_EQ(statesOf(report),
            (States{{"linear.toml", "failed"}, {"one.toml", "estimated"}, {"two.toml", "estimated"}}));
  const json one = entryOf(report, "one.toml").at("estimate"),
             two = entryOf(report, "two.toml").at("estimate");
  EXPECT_DOUBLE_EQ(report.at("estimate").at("seconds"),
                   one.at("seconds").at("total").get<double>() + two.at("seconds").at("total").get<double>());
  EXPECT_EQ(report.at("estimate").at("memory_bytes"),
            std::max(one.at("memory_bytes").get<double>(), two.at("memory_bytes").get<double>()));
  EXPECT_FALSE(fs::exists(path("models")));
  EXPECT_EQ(leftOvers(), std::vector<std::string>());
  const ProgramResult table =
      solve({"--batch", path("cases"), "--dry-run", "--threads", "2", "-o", path("models")});
  EXPECT_NE(table.out.find("MB of scratch"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("2 to be solved, 1 failed; together about "), std::string::npos) << table.out;
}

TEST_F(SolvedInBatches, LieInAFolderOfTheirOwnWhereAsked) {
  addCase("one.toml", quick_);
  addCase("two.toml", quick_);
  const ProgramResult result = solve({"--batch", path("cases"), "-o", path("models/of/today")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* const name : {"one.h5", "one.xdmf", "two.h5", "two.xdmf"})
    EXPECT_TRUE(fs::exists(folder_ / "models/of/today" / name)) << name;
  EXPECT_FALSE(fs::exists(inCases("one.h5")));
  EXPECT_TRUE(result.out.empty()) << result.out;
  for (const char* const part :
       {"2 cases, 2 to solve, 0 have their model, 0 cannot be solved\n", "case 1 of 2: one.toml\n",
        "case 2 of 2: two.toml; about ", "\none.toml  solved  ", "2 solved; "})
    EXPECT_NE(result.err.find(part), std::string::npos) << part << '\n' << result.err;
}

TEST_F(SolvedInBatches, RefuseWhatIsNoBatch) {
  const auto refused = [&](const std::vector<std::string>& words, int code, const std::string& part) {
    const ProgramResult result = solve(words);
    EXPECT_EQ(result.exit_code, code) << part;
    expectRefusal(result, part);
  };
  const std::string cases = path("cases");
  refused({"--batch", path("none")}, 1, "none: cannot be read as a folder: No such file or directory");
  refused({"--batch", path("block.msh")}, 1, "block.msh: cannot be read as a folder: Not a directory");
  refused({"--batch", cases}, 1, "cases: no case file (*.toml) is in it");
  addCase("one.toml", quick_);
  for (const std::string worker : {"0/2", "3/2", "2", "1/", "/2", "1/2x", "-1/2", "1/0", "x"})
    refused({"--batch", cases, "--worker=" + worker}, 2, "--worker " + worker + " is not I/N");
  refused({path("block.msh"), "--worker", "1/2"}, 2, "--worker is of a --batch");
  refused({path("block.msh"), "--batch", cases}, 2, "--batch does not go with the input");
  refused({"--batch", cases, "--template"}, 2, "--batch does not go with --template");
  refused({"--batch", cases, "--method", "foo"}, 2, "--method");
  refused({"--batch", cases, "-o", path("block.msh")}, 2, "--output");
  refused({"--batch", cases, "--scratch", path("none")}, 2, "--scratch");
  EXPECT_EQ(leftOvers(), std::vector<std::string>());
}

}  // namespace
}  // namespace palpate
