// SPDX-License-Identifier: Apache-2.0
// palpate-fit as its user sees it: exit code, standard output, standard error, files.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>

#include "palpate/testing/run_program.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/xml_fault.h"
#include "tools/examine/query/answer.h"
#include "tools/modelfile/write_certificate.h"
#include "tools/program/printed.h"

namespace palpate::fit {
namespace {

using palpate::testing::contentOf;
using palpate::testing::expectOneLineError;
using palpate::testing::ProgramResult;
using palpate::testing::runProgram;
using program::printed;
using ::testing::HasSubstr;
using ::testing::Not;

/// A model, and curves of an organ whose E is 0.4 times its own, measured at the surface point nearest to kPlace.
struct Bench {
  static constexpr const char* kPlace = "0.01,0,0.05";
  static constexpr double kScale = 0.4, kOffset = 0.5;  // mm

  palpate::testing::TemporaryFolder folder;
  std::filesystem::path path{folder / "organ.h5"};
  MetaModel model{load()};
  query::Anchor anchor{query::anchorNear(model, {0.01, 0.0, 0.05})};

  [[nodiscard]] MetaModel load() const {
    palpate::testing::writeSyntheticModel(path,
                                          {.subdivisions = 2, .nonlinearity = 0.3, .nodule_above = 0.4});
    return MetaModel::load(path);
  }
  [[nodiscard]] double forceAt(double mm) const {  // N, of the model
    const Vec3 d = -1e-3 * mm * model.surface().normal(anchor.s);
    return query::ask(model, anchor, d).response.force.dot(d.normalized());
  }
  /// @param bend  N/mm^2, added  @return what --measured takes
  [[nodiscard]] std::string curve(double noise, double bend = 0.0, double deepest = 7.0) const {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    std::string text = "depth_mm,force_mN\n";
    for (double mm = 0.0; mm <= deepest; mm += 0.125) {
      const double depth = std::max(mm - kOffset, 0.0), force = depth > 0.0 ? kScale * forceAt(depth) : 0.0;
      text += printed("%.6f,%.9f\n", mm, 1e3 * (force + bend * depth * depth + noise * normal(random)));
    }
    return folder.write("curve.csv", text).string();
  }
  [[nodiscard]] ProgramResult fit(const std::string& curve, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"--model", path.string(), "--measured", curve};
    if (std::find(more.begin(), more.end(), "--node") == more.end())
      more.insert(more.end(), {"--at", kPlace});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("palpate-fit", arguments);
  }
};

TEST(FitProgram, FindsTheModulusOfANoisyCurve) {
  const Bench bench;
  const auto plot = bench.folder / "fit.svg";
  const ProgramResult run = bench.fit(bench.curve(0.002), {"--json", "--plot", plot.string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  const double E = Bench::kScale * bench.model.attributes().E;
  EXPECT_LT(json["E_interval"][0], E);
  EXPECT_GT(json["E_interval"][1], E);
  EXPECT_NEAR(json["E"], E, 0.02 * E);
  EXPECT_LT(json["offset_interval"][0], 1e-3 * Bench::kOffset);
  EXPECT_GT(json["offset_interval"][1], 1e-3 * Bench::kOffset);
  EXPECT_EQ(json["confidence"], 0.99);
  EXPECT_EQ(json["points"], 57);
  EXPECT_EQ(json["curve"].size(), 57U);
  EXPECT_EQ(json["beyond_domain"], 0);
  EXPECT_EQ(json["other_form"], false);
  EXPECT_NEAR(json["rms_residual"], 0.002, 0.0006);
  EXPECT_EQ(json["certified"], false);
  EXPECT_EQ(json["model_id"], bench.model.id());
  EXPECT_DOUBLE_EQ(json["regions"]["nodule"], json["scale"].get<double>() * bench.model.view().region_E[1]);
  EXPECT_EQ(palpate::testing::xmlFault(contentOf(plot)), "");
}

TEST(FitProgram, SaysItInWordsWithWhatAServerTakes) {
  const Bench bench;
  const ProgramResult run = bench.fit(bench.curve(0.0));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string E = printed("%.6g", Bench::kScale * bench.model.attributes().E);
  EXPECT_THAT(run.out,
              HasSubstr("palpate-server --youngs-modulus " + E + ", or [organ] youngs_modulus = " + E));
  EXPECT_THAT(run.out, HasSubstr("palpate-parameters --youngs-modulus " + E + "\n"));
  EXPECT_THAT(run.out, HasSubstr("\ncontact begins    at 0.5 mm, "));
  EXPECT_THAT(run.err, HasSubstr("the model is not certified"));
}

TEST(FitProgram, WritesAModelThatHasTheModulus) {
  const Bench bench;
  const auto copy = bench.folder / "softer.h5";
  const ProgramResult run = bench.fit(bench.curve(0.0), {"--json", "--write", copy.string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  const MetaModel softer = MetaModel::load(copy);
  EXPECT_EQ(json["written_id"], softer.id());
  EXPECT_EQ(json["E"], softer.attributes().E);
  const auto fitted = nlohmann::json::parse(softer.attributes().provenance)["fitted"];
  EXPECT_EQ(fitted["from_model"], bench.model.id());
  EXPECT_EQ(fitted["from_E"], bench.model.attributes().E);
  const std::vector<std::string> touch{"--at", Bench::kPlace, "--displacement", "0,0.001,-0.004", "--json"};
  const auto force = [&](const std::filesystem::path& model) {
    std::vector<std::string> arguments{model.string()};
    arguments.insert(arguments.end(), touch.begin(), touch.end());
    return nlohmann::json::parse(runProgram("palpate-query", arguments).out)["force"];
  };
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(force(copy)[k], json["scale"].get<double>() * force(bench.path)[k].get<double>(), 1e-12);
}

TEST(FitProgram, ACertificateWidensTheIntervalByWhatItBounds) {
  const Bench bench;
  modelfile::writeCertificate(bench.path, R"({"travel": 0.005, "force_error": {"bound_95_95": 0.01}})",
                              bench.model.digest());
  const ProgramResult run = bench.fit(bench.curve(0.0), {"--json", "--no-offset", "--deepest", "0.0004"});
  EXPECT_NE(run.exit_code, 0);  // nothing but points before contact
  const auto json = nlohmann::json::parse(bench.fit(bench.curve(0.0), {"--json"}).out);
  EXPECT_GE(json["E_model_error"], 0.01 * json["E"].get<double>());
  EXPECT_LT(json["E_model_error"], 0.1 * json["E"].get<double>());
  EXPECT_NEAR(json["E_interval"][1].get<double>() - json["E"].get<double>(),
              json["E_model_error"].get<double>() + json["E_scatter"].get<double>(), 1e-6);
}

TEST(FitProgram, WarnsOfPointsBeyondTheDomainAndOfAnotherForm) {
  const Bench bench;
  const ProgramResult deep = bench.fit(bench.curve(0.002, 0.0, 10.0));
  ASSERT_EQ(deep.exit_code, 0) << deep.err;
  EXPECT_THAT(deep.err, HasSubstr("12 of 76 points in contact are deeper than d_max = 8 mm"));
  const ProgramResult left_out = bench.fit(bench.curve(0.002, 0.0, 10.0), {"--deepest", "0.008"});
  EXPECT_THAT(left_out.err, Not(HasSubstr("deeper than d_max")));
  const ProgramResult bent = bench.fit(bench.curve(0.002, 0.02));
  ASSERT_EQ(bent.exit_code, 0) << bent.err;
  EXPECT_THAT(bent.err, HasSubstr("the measured curve has another form than the model's"));
}

TEST(FitProgram, RefusesWrongArguments) {
  const Bench bench;
  const std::string curve = bench.curve(0.0);
  const auto none = bench.folder / "none.csv";
  expectOneLineError(bench.fit(none.string()),
                     "cannot read " + none.string() + ": No such file or directory");
  const auto wrong = bench.folder.write("wrong.csv", "depth_mm,force_N\n1,2\n2,NaN\n").string();
  expectOneLineError(bench.fit(wrong),
                     wrong + ", line 3: column 'force_N' is 'NaN', expected a finite number");
  expectOneLineError(bench.fit(curve, {"--direction", "0,0,1"}), "does not lead into the organ");
  expectOneLineError(bench.fit(curve, {"--direction", "0,0,0"}), "--direction is '0,0,0'");
  expectOneLineError(bench.fit(curve, {"--node", "999999"}), "node 999999 is not in the mesh");
  expectOneLineError(bench.fit(curve, {"--confidence", "nan"}),
                     "--confidence: nan is out of range, expected 0.5 to 0.9999");
  expectOneLineError(bench.fit(curve, {"--deepest", "nan"}), "--deepest is nan, expected a finite depth");
  expectOneLineError(bench.fit(curve, {"--deepest", "0.0001"}),
                     "curve.csv has 1 different depths, expected 3");
  const auto missing = bench.folder / "missing" / "fit";
  for (const char* option : {"--plot", "--write"})
    expectOneLineError(bench.fit(curve, {option, missing.string()}),
                       "cannot write " + missing.string() + ": No such file or directory");
}

TEST(FitProgram, ReplacesNothingThatItReads) {
  const Bench bench;
  const std::string curve = bench.curve(0.0), model = contentOf(bench.path), readings = contentOf(curve);
  const auto link = bench.folder / "link";
  std::filesystem::create_symlink(bench.path, link);
  for (const std::string option : {"--plot", "--write"}) {
    for (const auto& file : {bench.path, bench.path.parent_path() / "." / bench.path.filename(), link})
      expectOneLineError(bench.fit(curve, {option, file.string()}),
                         option + " is the file of --model, " + file.string() + ": expected another file");
    expectOneLineError(bench.fit(curve, {option, curve}),
                       option + " is the file of --measured, " + curve + ": expected another file");
  }
  const auto fresh = bench.folder / "fresh";
  const auto same = bench.path.parent_path() / "." / "fresh";
  expectOneLineError(bench.fit(curve, {"--plot", fresh.string(), "--write", same.string()}),
                     "--write is the file of --plot, " + same.string() + ": expected another file");
  EXPECT_FALSE(std::filesystem::exists(fresh));
  EXPECT_TRUE(contentOf(bench.path) == model);
  EXPECT_EQ(contentOf(curve), readings);
}

TEST(FitProgram, ForcesThatAreAlikeHaveNoRSquared) {
  const Bench bench;
  const auto curve =
      bench.folder.write("flat.csv", "depth_mm,force_N\n1,0.1\n2,0.1\n3,0.1\n4,0.1\n").string();
  const ProgramResult run = bench.fit(curve, {"--no-offset", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(nlohmann::json::parse(run.out)["r_squared"].is_null());
  EXPECT_THAT(bench.fit(curve, {"--no-offset"}).out, Not(HasSubstr("R2")));
  EXPECT_THAT(bench.fit(bench.curve(0.0)).out, HasSubstr("; R2 1.0"));
}

TEST(FitProgram, RefusesModelsThatAreDrivenByALoad) {
  const palpate::testing::TemporaryFolder folder;
  const auto path = folder / "force.h5";
  palpate::testing::writeSyntheticModel(path, {.subdivisions = 1, .parameters = Parameters::kForce});
  const auto curve = folder.write("curve.csv", "depth_mm,force_N\n1,1\n2,2\n3,3\n");
  expectOneLineError(
      runProgram("palpate-fit", {"--model", path.string(), "--measured", curve.string(), "--at", "0,0,0.05"}),
      path.string() + " is driven by force; fit takes displacement models");
}

}  // namespace
}  // namespace palpate::fit
