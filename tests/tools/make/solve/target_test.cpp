// SPDX-License-Identifier: Apache-2.0
// What palpate-solve chooses by a target, and says of it.
#include <nlohmann/json.hpp>

#include "solved_block.h"

namespace palpate {
namespace {

using SolveTarget = SolveProgram;

TEST_F(SolveTarget, SaysHowMuchOfTheSurfaceReachesATravel) {
  const auto solved = [&](const std::string& travel, bool warned) {
    const ProgramResult result = solve({path("block.msh"), "--travel", travel, "--modes", "20",
                                        "--element-order", "1", "-o", path("out.h5"), "-q", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("are within d_max at 16 places, by degrees of field and force (3, 6)"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(result.err.find("warning: of touches of up to") != std::string::npos, warned) << result.err;
    return nlohmann::json::parse(result.out);
  };
  const auto summary = solved("0.03", true), near = solved("0.0005", false);
  EXPECT_EQ(summary.at("travel").at("travel"), 0.03);
  EXPECT_EQ(summary.at("travel").at("places"), 16);
  EXPECT_LT(summary.at("travel").at("touches"), 0.5);
  EXPECT_EQ(near.at("travel").at("touches"), 1.0);
  double area = 0.0, touches = 0.0;
  for (const auto& side : summary.at("sides")) {
    area += side.at("area_share").get<double>();
    touches += side.at("area_share").get<double>() * side.at("touches").get<double>();
  }
  EXPECT_NEAR(area, 1.0, 1e-12);
  EXPECT_NEAR(touches, summary.at("travel").at("touches").get<double>(), 1e-12);
  EXPECT_LT(near.at("order"), summary.at("order"));
  EXPECT_GT(summary.at("seconds").at("orders"), 0.0);
  const auto file = nlohmann::json::parse(runProgram("palpate-inspect", {path("out.h5"), "--json"}).out);
  for (const char* key : {"reach", "domain_radius", "series_radius", "order", "force_order"})
    EXPECT_EQ(file.at(key), near.at(key)) << key;
  EXPECT_EQ(file.at("provenance").at("travel"), 0.0005);
}

TEST_F(SolveTarget, RefusesATravelBeyondEveryDomainRadius) {
  expectRefusal(solve({path("block.msh"), "--travel", "0.06", "-o", path("out.h5")}), "0.05");
  expectRefusal(solve({path("block.msh"), "--travel", "0.01", "--order", "3", "-o", path("out.h5")}),
                "--travel does not go with --order");
}

TEST_F(SolveTarget, ATravelOrAnOrderReplacesWhatTheCaseSaysOfBoth) {
  const auto summary = [&](const std::string& keys, const std::string& option, const std::string& value) {
    const ProgramResult result = solve({writeCase("[model]\nmodes = 20\n" + keys), "--element-order", "1",
                                        option, value, "-o", path("out.h5"), "-q", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  const auto travelled = summary("order = 4\nforce_order = 8\n", "--travel", "0.0005");
  EXPECT_EQ(travelled.at("order"), 3);
  EXPECT_EQ(travelled.at("force_order"), 6);
  EXPECT_TRUE(travelled.contains("travel"));
  EXPECT_EQ(summary("order = 4\nforce_order = 8\n", "--order", "2").at("force_order"), 4);
  const auto ordered = summary("[target]\ntravel = 0.0005\n", "--order", "2");
  EXPECT_EQ(ordered.at("order"), 2);
  EXPECT_FALSE(ordered.contains("travel"));
}

TEST_F(SolveTarget, SaysWhatItChoseAndWhy) {
  const auto summary = [&](const std::string& keys, std::vector<std::string> options) {
    options.insert(options.begin(), {writeCase(keys), "--element-order", "1"});
    options.insert(options.end(), {"-o", path("out.h5"), "-q", "--json"});
    const ProgramResult result = solve(options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  const auto chosen = summary("", {"--travel", "0.001", "--field-error", "0.03"});
  const auto given = summary("[model]\nnear_radius = 0.02\n", {"--order", "2", "--modes", "20"});
  const auto why = [](const nlohmann::json& s, const char* key) {
    return s.at("chosen").at(key).at("why").get<std::string>();
  };
  for (const char* key : {"order", "force_order", "modes", "near_radius"}) {
    EXPECT_NE(why(chosen, key), "given") << key;
    EXPECT_EQ(why(given, key), "given") << key;
  }
  EXPECT_FALSE(why(chosen, "mid_edges").empty());
  EXPECT_EQ(chosen.at("chosen").at("order").at("value"), chosen.at("order"));
  EXPECT_EQ(chosen.at("chosen").at("modes").at("value"), chosen.at("modes"));
  EXPECT_EQ(chosen.at("positions").at("corners"), chosen.at("contact_positions"));
  EXPECT_EQ(chosen.at("positions").at("mid_edges"), chosen.at("chosen").at("mid_edges").at("value"));
  EXPECT_LE(chosen.at("fit_p95"), 0.03);
  EXPECT_EQ(given.at("near_radius"), 0.02);
  EXPECT_FALSE(given.contains("travel"));
  fs::remove(folder_ / "out.h5");
  expectRefusal(solve({path("block.msh"), "--field-error", "0.02", "--modes", "9", "-o", path("out.h5")}),
                "--field-error does not go with --modes");
}

TEST_F(SolveTarget, AModelWithoutEdgesDoesNotTrustItselfFurtherThanOneWithThem) {
  const auto summary = [&](const std::string& option, const std::string& value) {
    const ProgramResult result =
        solve({writeCase("[model]\nmodes = 20\npatch_radius = 0.008\n"), "--element-order", "1", option,
               value, "-o", path("out.h5"), "-q", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  const auto with = summary("--order", "3"), without = summary("--travel", "0.00001");
  EXPECT_GT(with.at("positions").at("mid_edges"), 0);
  EXPECT_EQ(without.at("positions").at("mid_edges"), 0);
  EXPECT_EQ(with.at("order"), without.at("order"));
  EXPECT_LE(without.at("domain_radius").at("median"), with.at("domain_radius").at("median"));
}

TEST_F(SolveTarget, ADryRunCountsWhatTheSolveTakes) {
  const std::vector<std::string> about{path("block.msh"),
                                       "--element-order",
                                       "1",
                                       "--travel",
                                       "0.001",
                                       "--modes",
                                       "20",
                                       "-o",
                                       path("dry.h5"),
                                       "-q",
                                       "--json"};
  std::vector<std::string> dry = about;
  dry.push_back("--dry-run");
  const ProgramResult found = solve(dry);
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_FALSE(std::filesystem::exists(path("dry.h5")));
  const auto estimate = nlohmann::json::parse(found.out);
  const auto summary = nlohmann::json::parse(solve(about).out);
  EXPECT_EQ(estimate.at("order"), summary.at("order"));
  EXPECT_EQ(estimate.at("modes"), 20);
  EXPECT_NEAR(estimate.at("file_bytes").get<double>() / summary.at("file_bytes").get<double>(), 1.0, 0.3);
  EXPECT_GT(estimate.at("seconds").at("total"), 0.0);
  EXPECT_GT(estimate.at("memory_bytes"), 1e6);
  expectRefusal(solve({path("block.msh"), "--dry-run", "--method", "series-force", "-o", path("dry.h5")}),
                "--dry-run is for method series-displacement");
}

/// In the bytes that it is stored in: half of another's.
TEST_F(SolveTarget, ADryRunCountsASmallFile) {
  std::vector<std::string> options{path("block.msh"), "--target", "handheld", "--size-limit", "1e8", "-o",
                                   path("small.h5"),  "-q",       "--json"};
  const auto summary = nlohmann::json::parse(solve(options).out);
  options.push_back("--dry-run");
  const auto estimate = nlohmann::json::parse(solve(options).out);
  const double bytes = summary.at("file_bytes");
  EXPECT_LT(bytes, 0.9e8);  // the limit says nothing
  EXPECT_EQ(estimate.at("modes"), summary.at("modes"));
  EXPECT_NEAR(estimate.at("file_bytes").get<double>() / bytes, 1.0, 0.3);
}

TEST_F(SolveTarget, RefusesATargetOrASizeThatThereIsNot) {
  const auto refuses = [this](std::vector<std::string> options, const std::string& part) {
    options.insert(options.begin(), {path("block.msh"), "-o", path("out.h5")});
    expectRefusal(solve(options), part);
  };
  refuses({"--target", "phone"}, "--target phone is not known (known: server, handheld)");
  refuses({"--target", "handheld", "--size-limit", "1000"}, "--size-limit: 1000 is out of range");
  refuses({"--size-limit", "8e6"}, "target.size_limit does not go with target.machine = \"server\"");
}

}  // namespace
}  // namespace palpate
