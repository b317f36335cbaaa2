// SPDX-License-Identifier: Apache-2.0
// palpate-certify as its user sees it: exit code, standard output, standard error, the file.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "../query/load_models.h"
#include "palpate/testing/run_program.h"
#include "palpate/testing/xml_fault.h"
#include "tools/examine/certify/touch_sampler.h"
#include "tools/modelfile/write_certificate.h"

namespace palpate::certify {
namespace {

using palpate::testing::contentOf;
using palpate::testing::expectOneLineError;
using palpate::testing::ProgramResult;
using palpate::testing::runProgram;
using query::test::BoxModel;
using query::test::LoadModel;
using ::testing::HasSubstr;
using ::testing::Not;

ProgramResult certify(const std::filesystem::path& model, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), model.string());
  return runProgram("palpate-certify", arguments);
}

TEST(CertifyProgram, WritesWhatItPrintsAndInspectShowsIt) {
  const BoxModel box("stable-neo-hookean", 2);
  const auto plot = box.folder / "errors.svg";
  const ProgramResult run = certify(box.path, {"--travel", "0.002", "--json", "--plot", plot.string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["samples"], 181);
  EXPECT_EQ(json["seed"], seedOf(box.model));
  EXPECT_EQ(json["model_id"], box.model.id());
  EXPECT_EQ(json["travel_from"], "asked for");
  EXPECT_TRUE(json["written"]);
  EXPECT_LT(json["force_error"]["bound_95_95"], json["force_error"]["max"]);
  EXPECT_EQ(palpate::testing::xmlFault(contentOf(plot)), "");

  const MetaModel certified = MetaModel::load(box.path);
  EXPECT_EQ(certified.id(), box.model.id());
  const auto kept = nlohmann::json::parse(certified.attributes().certificate);
  for (const auto& [key, value] : kept.items()) EXPECT_EQ(json[key], value) << key;
  const auto inspected =
      nlohmann::json::parse(runProgram("palpate-inspect", {"--json", box.path.string()}).out);
  EXPECT_EQ(inspected["certificate"], kept);
  const ProgramResult table = runProgram("palpate-inspect", {box.path.string()});
  EXPECT_THAT(table.out, HasSubstr("certificate               certified for touches to 2 mm: of touches in "
                                   "the domain, 95 % are within "));
  EXPECT_THAT(table.out, HasSubstr("certificate.samples       181\n"));
}

TEST(CertifyProgram, AMeasurementLeavesTheFileAsItIs) {
  const BoxModel box;
  const std::string before = contentOf(box.path);
  for (const std::vector<std::string>& only :
       {std::vector<std::string>{"--no-write"}, {"--seed", "7"}, {"--inward"}, {"--length", "0.001"}}) {
    std::vector<std::string> arguments{"--samples", "2", "--json"};
    arguments.insert(arguments.end(), only.begin(), only.end());
    const ProgramResult run = certify(box.path, arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_FALSE(nlohmann::json::parse(run.out)["written"]) << only.front();
    EXPECT_TRUE(contentOf(box.path) == before) << only.front();
  }
  const ProgramResult shown = runProgram("palpate-inspect", {box.path.string()});
  EXPECT_THAT(shown.out, HasSubstr("certificate               not certified"));
}

TEST(CertifyProgram, SaysInWordsWhatItFound) {
  const BoxModel box;
  const ProgramResult run = certify(box.path, {"--samples", "3"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("travel    5 mm (the default of this stiffness), seed " +
                                 std::to_string(seedOf(box.model))));
  EXPECT_THAT(run.out, HasSubstr("too few samples for a bound"));
  EXPECT_THAT(run.out,
              HasSubstr("\nnot certified for touches to 5 mm: 3 samples in the domain, a bound takes 59\n"));
  EXPECT_THAT(run.out,
              HasSubstr("\nnot written into " + box.path.string() + " (a certificate takes 59 samples)"));
  const ProgramResult measured = certify(box.path, {"--samples", "1", "--inward"});
  EXPECT_THAT(measured.out, HasSubstr("\nmeasured, not a certificate: "));
  EXPECT_THAT(measured.out, Not(HasSubstr("certified for")));
}

TEST(CertifyProgram, FewSamplesLeaveTheCertificateThatIsThere) {
  const BoxModel box;
  modelfile::writeCertificate(box.path, R"({"samples": 93})", box.model.digest());
  const std::string before = contentOf(box.path);
  const ProgramResult run = certify(box.path, {"--samples", "2", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(nlohmann::json::parse(run.out)["written"]);
  EXPECT_TRUE(contentOf(box.path) == before);
}

TEST(CertifyProgram, ExaminesPairsOfTools) {
  const BoxModel box("stable-neo-hookean", 2);
  const ProgramResult run =
      certify(box.path, {"--samples", "2", "--travel", "0.001", "--two-tools", "--inward", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["two_tools"]["samples"], 4);
  EXPECT_GT(json["two_tools"]["force_error"]["max"], 0.0);
  EXPECT_TRUE(json["two_tools"]["least_distance"].is_null());
  EXPECT_EQ(json["inward"], true);
  EXPECT_TRUE(json["length"].is_null());
  EXPECT_EQ(json["touches"].size(), json["drawn"]);
  EXPECT_EQ(json["touches"][0]["outcome"], json["touches"][0]["beyond_domain"] ? "beyond" : "within");
}

TEST(CertifyProgram, RefusesModelsThatAreDrivenByALoad) {
  const LoadModel force(Parameters::kForce), level(Parameters::kLevel);
  expectOneLineError(certify(force.path, {}),
                     force.path.string() + " is driven by force; certify takes displacement models");
  expectOneLineError(certify(level.path, {}),
                     level.path.string() + " is driven by level; certify takes displacement models");
}

TEST(CertifyProgram, RefusesWrongArguments) {
  const BoxModel box;
  const std::string before = contentOf(box.path);
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{{"--samples", "0"},
                                                                                      {"--travel", "0"},
                                                                                      {"--travel", "nan"},
                                                                                      {"--length", "nan"},
                                                                                      {"--length", "1"},
                                                                                      {"--threads", "0"},
                                                                                      {"--seed", "-1"}}) {
    const ProgramResult run = certify(box.path, {option, value});
    EXPECT_NE(run.exit_code, 0) << option;
    EXPECT_THAT(run.err, HasSubstr(option)) << value;
  }
  EXPECT_TRUE(contentOf(box.path) == before);
  const auto none = box.folder / "none.h5";
  expectOneLineError(certify(none, {}), none.string());
  const auto link = box.folder / "link.h5";
  std::filesystem::create_symlink(box.path, link);
  for (const auto& model : {box.path, box.path.parent_path() / "." / box.path.filename(), link}) {
    const ProgramResult run = certify(box.path, {"--samples", "2", "--plot", model.string()});
    expectOneLineError(run, "--plot is the model itself, " + model.string() + ": expected another file");
    EXPECT_THAT(run.err, Not(HasSubstr("full solutions")));
  }
  EXPECT_TRUE(contentOf(box.path) == before);
  const auto plot = box.folder / "missing" / "errors.svg";
  const ProgramResult run = certify(box.path, {"--samples", "2", "--plot", plot.string()});
  expectOneLineError(run, "cannot write " + plot.string() + ": No such file or directory");
  EXPECT_THAT(run.err, Not(HasSubstr("full solutions")));  // before anything is solved
}

}  // namespace
}  // namespace palpate::certify
