// SPDX-License-Identifier: Apache-2.0
// What a reader gets of palpate-certify --report, of a model file whose texts are hostile.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../query/box_model.h"
#include "palpate/testing/run_program.h"

namespace palpate::certify {
namespace {

using nlohmann::json;
using palpate::testing::contentOf;
using palpate::testing::expectOneLineError;
using palpate::testing::ProgramResult;
using palpate::testing::runProgram;
using palpate::testing::TemporaryFolder;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHostile = "\"><script>alert(1)</script>";

/// A box with a stiff region on springs, whose texts try to leave the page's text.
struct HostileModel {
  TemporaryFolder folder;
  std::filesystem::path path{folder / "box <1>.h5"};

  HostileModel() {
    modelfile::ModelData data =
        query::test::boxModelData(folder.path(), "stvk", 1, query::test::BoxCase::kRegionAndSprings);
    for (RegionName& name : data.region_name)
      if (textOf(name) == "nodule") name = regionName(kHostile);
    data.attributes.provenance =
        json{{"mesh", kHostile},
             {"case", "</pre>{{model}}\x1b[31m"},
             {"mesh_error", {{"mean", 0.0213}, {"max", 0.05}, {"against", kHostile}}}}
            .dump();
    modelfile::writeModel(path, data);
  }
  [[nodiscard]] ProgramResult certify(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), path.string());
    return runProgram("palpate-certify", arguments);
  }
};

/// One report, read by all tests: of 3 touches of at most 2 mm, E known to 20 %.
class CertifyReport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    model_ = new HostileModel;
    run_ = new ProgramResult(
        model_->certify({"--samples", "3", "--travel", "0.002", "--json", "--report",
                         (model_->folder / "report").string(), "--youngs-modulus-error", "0.2"}));
  }
  static void TearDownTestSuite() {
    delete model_;
    delete run_;
  }
  void SetUp() override { ASSERT_EQ(run_->exit_code, 0) << run_->err; }

  [[nodiscard]] static std::filesystem::path file(const char* name) {
    return model_->folder.path() / "report" / name;
  }
  [[nodiscard]] static std::string page() { return contentOf(file("report.html")); }
  [[nodiscard]] static std::string faultsOf(const std::filesystem::path& page) {
    const ProgramResult faults = runProgram(PALPATE_PYTHON, {"-B", PALPATE_PAGE_FAULTS, page.string()});
    return faults.exit_code == 0 ? faults.out : faults.err;
  }
  [[nodiscard]] static json content() { return json::parse(contentOf(file("report.json"))); }

  static HostileModel* model_;
  static ProgramResult* run_;
};
HostileModel* CertifyReport::model_ = nullptr;
ProgramResult* CertifyReport::run_ = nullptr;

TEST_F(CertifyReport, TheCheckOfThePageFindsFaults) {
  for (const auto& [part, other, fault] : std::vector<std::array<const char*, 3>>{
           {"</section>", "", "closes nothing"},
           {"<h2>4. Mesh</h2>", "<h2></h2>", "<h2> is empty"},
           {"<img src=\"data:", "<img src=\"https:", "a picture is elsewhere"},
           {"alt=\"", "title=\"", "a picture has no text beside it"},
           {"href=\"#mesh\"", "href=\"#mash\"", "link to #mash leads nowhere"},
           // <svg xmlns="http://www.w3.org/2000/svg"><path d="M1.0 nanH-inf"/></svg>
           {"src=\"data:image/svg+xml;base64,",
            "src=\"data:image/"
            "svg+xml;base64,"
            "PHN2ZyB4bWxucz0iaHR0cDovL3d3dy53My5vcmcvMjAwMC9zdmciPjxwYXRoIGQ9Ik0xLjAgbmFuSC1pbmYiLz48L3N2Zz4="
            "\" title=\"",
            "a picture's <path> has nan"},
           {"<main>", "<main onclick=\"x\">", "runs or loads something"}}) {
    std::string text = page();
    text.replace(text.find(part), std::string(part).size(), other);
    EXPECT_THAT(faultsOf(model_->folder.write("wrong.html", text)), HasSubstr(fault));
  }
}

TEST_F(CertifyReport, IsAPageThatNestsAndLoadsNothing) {
  EXPECT_EQ(faultsOf(file("report.html")), "");
}

TEST_F(CertifyReport, HasThePartsOfVAndV40InTheirOrder) {
  std::size_t at = 0;
  const std::string text = page();
  for (const char* part :
       {"context", "quantity", "code", "mesh", "form", "comparator", "uncertainty", "applicability"}) {
    const std::size_t next = text.find("<section id=\"" + std::string(part) + "\">\n<h2>");
    ASSERT_NE(next, std::string::npos) << part;
    EXPECT_GT(next, at) << part;
    EXPECT_NE(text.find("href=\"#" + std::string(part) + "\""), std::string::npos) << part;
    at = next;
  }
}

TEST_F(CertifyReport, SaysWhatItFound) {
  const std::string text = page();
  EXPECT_THAT(
      text,
      HasSubstr("not certified for touches to 2 mm: 3 samples in the domain, a bound takes 59; not written"));
  EXPECT_THAT(text, HasSubstr("No bound is claimed: it takes 59 touches in the domain, and there are 3."));
  EXPECT_THAT(text, HasSubstr("<td>no bound</td>"));
  EXPECT_THAT(text, HasSubstr("presses by up to 2 mm (asked for), in any direction"));
  EXPECT_THAT(text, HasSubstr("off by 2.13 % in the mean of the points and by 5 % at most"));
  EXPECT_THAT(text, HasSubstr("with E off by 20 % either way"));
  EXPECT_THAT(text, HasSubstr("The springs that hold the organ do not change with E"));
  EXPECT_THAT(text, HasSubstr("<td>stable-neo-hookean</td><td>500 kPa</td><td>0.3</td>"));
  EXPECT_THAT(text, HasSubstr("Not examined here (--two-tools)"));
}

TEST_F(CertifyReport, EscapesTextsOfTheFile) {
  const std::string text = page();
  EXPECT_THAT(text, Not(HasSubstr("<script")));
  EXPECT_THAT(text,
              HasSubstr("<td>&quot;&gt;&lt;script&gt;alert(1)&lt;/script&gt;</td><td>stable"));  // the region
  EXPECT_THAT(text, HasSubstr("Mesh</th><td>&quot;&gt;&lt;script&gt;"));
  EXPECT_THAT(text, HasSubstr("Against &quot;&gt;&lt;script&gt;"));
  EXPECT_THAT(text, HasSubstr("<pre>&lt;/pre&gt;{{model}}"));
  EXPECT_THAT(text, HasSubstr("?[31m"));  // ESC
  EXPECT_THAT(text, HasSubstr("box &lt;1&gt;.h5</h1>"));
  EXPECT_THAT(text, HasSubstr("box &lt;1&gt;.h5&apos; --at="));  // one word for a shell
}

TEST_F(CertifyReport, HoldsTheSameInNumbers) {
  const json c = content();
  const json printed = json::parse(run_->out);
  for (const auto& [key, value] : c["certificate"].items()) EXPECT_EQ(printed[key], value) << key;
  EXPECT_EQ(c["touches"], printed["touches"]);
  EXPECT_EQ(c["model_id"], printed["model_id"]);
  EXPECT_EQ(c["context_of_use"]["travel"], 0.002);
  EXPECT_EQ(c["context_of_use"]["made"]["mesh"], kHostile);
  EXPECT_TRUE(c["context_of_use"]["made"]["program"].is_null());
  EXPECT_EQ(c["model_form"]["regions"].size(), 2U);
  EXPECT_GT(c["model_form"]["springs"]["stiffness"], 0.0);
  EXPECT_EQ(c["mesh"]["element_order"], 1);
  EXPECT_NEAR(c["mesh"]["median_contact_edge"].get<double>(), 0.02, 1e-9);  // the box's cells
  const json& surface = c["surface"];
  const std::size_t nodes = surface["positions"].size() / 3;
  EXPECT_EQ(surface["domain_radius"].size(), nodes);
  EXPECT_EQ(surface["normal_stiffness"].size(), nodes);
  EXPECT_GT(std::count(surface["domain_radius"].begin(), surface["domain_radius"].end(), nullptr),
            0);  // the clamp
}

TEST_F(CertifyReport, WhatMustBeZeroIs) {
  const json checks = content()["code_verification"]["in_place"];
  for (const char* key : {"rotation", "resultant", "energy_asymmetry"}) {
    EXPECT_GE(checks[key].get<double>(), 0.0) << key;
    EXPECT_LT(checks[key].get<double>(), 1e-10) << key;
  }
}

TEST_F(CertifyReport, CurvesPassThroughFullNewton) {
  const json uncertainty = content()["uncertainty"];
  EXPECT_EQ(uncertainty["youngs_modulus_error"], 0.2);
  ASSERT_EQ(uncertainty["curves"].size(), 2U);
  for (const json& curve : uncertainty["curves"]) {
    EXPECT_EQ(curve["depth"].size(), curve["force"].size());
    EXPECT_EQ(curve["force"][0], 0.0);
    EXPECT_EQ(curve["depth"].back(), 0.002);
    ASSERT_GE(curve["newton"].size() + curve["not_converged"].get<std::size_t>(), 4U);
    const json& last = curve["newton"].back();
    EXPECT_EQ(last["depth"], 0.002);
    EXPECT_NEAR(curve["force"].back().get<double>(), last["force"].get<double>(),
                last["error"].get<double>() * std::abs(last["force"].get<double>()) * 1.5 + 1e-12);
    EXPECT_LT(last["error"], 0.1);
  }
  EXPECT_EQ(uncertainty["curves"][1]["newton"].size(), 5U);  // the worst touch's own length too
}

TEST_F(CertifyReport, LessOfTheSurfaceReachesFarther) {
  const json reach = content()["applicability"]["reach"];
  ASSERT_GE(reach.size(), 3U);
  EXPECT_EQ(reach.back()["travel"], 0.002);
  for (std::size_t i = 1; i < reach.size(); ++i) {
    EXPECT_GT(reach[i]["travel"], reach[i - 1]["travel"]);
    EXPECT_LE(reach[i]["share"], reach[i - 1]["share"]);
  }
}

TEST_F(CertifyReport, FiguresOfTheTestsStandInTheDocuments) {
  for (const json& held : content()["code_verification"]["held_by_tests"])
    EXPECT_THAT(contentOf(std::filesystem::path(PALPATE_SOURCE) / held["file"].get<std::string>()),
                HasSubstr(held["figure"].get<std::string>()));
}

TEST_F(CertifyReport, ReplacesAnOlderOne) {
  const std::string first = page();
  std::ofstream(file("report.html")) << "old";
  const ProgramResult run =
      model_->certify({"--samples", "1", "--travel", "0.002", "--report", file("").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(page(), HasSubstr("How well E is known was not given"));
  std::ofstream(file("report.html")) << first;
}

TEST_F(CertifyReport, IsRefusedBeforeAnythingIsSolved) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
    arguments.insert(arguments.begin(), {"--samples", "2"});
    const ProgramResult run = model_->certify(arguments);
    expectOneLineError(run, why);
    EXPECT_THAT(run.err, Not(HasSubstr("full solutions")));
  };
  const auto taken = model_->folder.write("taken", "");
  refused({"--report", taken.string()}, "cannot write " + taken.string() + ": it is not a folder");
  const auto dangling = model_->folder.path() / "dangling";
  std::filesystem::create_symlink(model_->folder.path() / "nowhere", dangling);
  for (const auto& folder : {dangling, dangling / ""})
    refused({"--report", folder.string()},
            "cannot write " + folder.string() + ": it is a link to a folder that is missing");
  const auto deep = model_->folder.path() / "missing" / "report";
  refused({"--report", deep.string()}, "cannot write " + deep.string() + ": No such file or directory");
  refused({"--report", model_->folder.path().string()},
          "cannot write " + model_->folder.path().string() + ": it holds other files, such as ");
  refused({"--youngs-modulus-error", "0.2"}, "--youngs-modulus-error goes with --report");
  const auto fresh = (model_->folder / "fresh").string();
  refused({"--report", fresh, "--youngs-modulus-error", "nan"},
          "--youngs-modulus-error: nan is out of range, expected 0 to 1");
  EXPECT_FALSE(std::filesystem::exists(fresh));
  EXPECT_NE(model_->certify({"--report", fresh, "--youngs-modulus-error", "1.5"}).exit_code, 0);
}

}  // namespace
}  // namespace palpate::certify
