// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "palpate/server/config_file.h"
#include "palpate/server/live_limits.h"
#include "palpate/testing/files.h"

namespace palpate::server {
namespace {

class ConfigFile : public ::testing::Test {
 protected:
  ServerConfig read(const std::string& text) {
    std::ofstream(path_) << text;
    ServerConfig config;
    readConfigFile(path_, config);
    return config;
  }

  // What the refusal says, without the path.
  std::string refusal(const std::string& text) {
    try {
      (void)read(text);
    } catch (const ConfigError& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find(path_.string()), 0U) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      return line.substr(path_.string().size());
    }
    return "accepted";
  }

  palpate::testing::TemporaryFile file_{"config.toml"};
  const std::filesystem::path path_ = file_.path();
};

TEST_F(ConfigFile, SetsWhatItNamesAndLeavesTheRest) {
  const ServerConfig config = read(
      "model = \"organ.h5\"\ndomain = 7\nrate = 500\nrealtime = \"off\"\nsurface_rate = 60\nphase_lock = "
      "true\n"
      "[tool]\nforce_limit = 2.5\n");
  EXPECT_EQ(config.model, path_.parent_path() / "organ.h5") << "relative to the file";
  EXPECT_EQ(config.domain, 7);
  EXPECT_EQ(config.rate, 500.0) << "an integer is a number too";
  EXPECT_EQ(config.realtime, rt::RealtimePolicy::kOff);
  EXPECT_EQ(config.surface_rate, 60.0);
  EXPECT_TRUE(config.phase_lock);
  EXPECT_EQ(config.step.force_limit, 2.5);
  EXPECT_EQ(config.step.tip_radius, StepConfig{}.tip_radius);
}

TEST_F(ConfigFile, TheFolderOfTheIdentityIsTakenFromTheFilesOwn) {
  EXPECT_EQ(read("security = \"desk\"").security, path_.parent_path() / "desk");
  EXPECT_THROW((void)read("security = \"\""), ConfigError);
}

TEST_F(ConfigFile, AnAbsoluteModelPathStaysAsItIs) {
  EXPECT_EQ(read("model = \"/data/organ.h5\"").model, "/data/organ.h5");
}

TEST_F(ConfigFile, TheSampleHoldsTheDefaults) {
  ServerConfig sample;
  readConfigFile(PALPATE_SAMPLE_CONFIG, sample);
  const ServerConfig defaults;
  EXPECT_EQ(sample.domain, defaults.domain);
  EXPECT_EQ(sample.rate, defaults.rate);
  EXPECT_EQ(sample.realtime, defaults.realtime);
  EXPECT_EQ(sample.surface_rate, defaults.surface_rate);
  EXPECT_EQ(sample.phase_lock, defaults.phase_lock);
  EXPECT_EQ(sample.tick_cpu, defaults.tick_cpu);
  EXPECT_EQ(sample.tick_cpu_alone, defaults.tick_cpu_alone);
  EXPECT_EQ(sample.step.tip_radius, defaults.step.tip_radius);
  EXPECT_EQ(sample.step.force_limit, defaults.step.force_limit);
  EXPECT_EQ(sample.step.stale_timeout, defaults.step.stale_timeout);
  EXPECT_EQ(sample.step.zero_after, defaults.step.zero_after);
  EXPECT_EQ(sample.step.ramp_time, defaults.step.ramp_time);
  EXPECT_EQ(sample.step.quaternion_tolerance, defaults.step.quaternion_tolerance);
  EXPECT_EQ(sample.device, defaults.device);
  EXPECT_EQ(sample.parameters, defaults.parameters);
  EXPECT_EQ(sample.step.coupling_stiffness, defaults.step.coupling_stiffness);
  EXPECT_EQ(sample.step.coupling_damping, defaults.step.coupling_damping);
  EXPECT_EQ(sample.step.friction, defaults.step.friction);
  EXPECT_EQ(sample.step.force_rate_limit, defaults.step.force_rate_limit);
  EXPECT_EQ(sample.step.speed_limit, defaults.step.speed_limit);
  EXPECT_EQ(sample.step.youngs_modulus, defaults.step.youngs_modulus);
  EXPECT_EQ(sample.step.tools, defaults.step.tools);
}

TEST_F(ConfigFile, RefusesAnUnknownKeyByNameAndLine) {
  EXPECT_EQ(refusal("domain = 1\n\nrat = 1000\n"), ":3: unknown key rat");
  EXPECT_EQ(refusal("[tool]\ntip_radios = 0.01\n"), ":2: unknown key tool.tip_radios");
  EXPECT_EQ(refusal("domain = 1\n[tol]\ntip_radius = 0.01\n"), ":2: unknown key tol");
}

TEST_F(ConfigFile, RefusesAQuotedKeyThatOnlyLooksLikeOneOfOurs) {
  EXPECT_EQ(refusal("\"tool.tip_radius\" = 0.01"), ":1: unknown key \"tool.tip_radius\"");
}

TEST_F(ConfigFile, RefusesEmptyWordsByNameAndLine) {
  EXPECT_EQ(refusal("\nmodel = \"\""), ":2: model is empty, expected the path of a model file");
  EXPECT_EQ(refusal("realtime = \"\""), ":1: realtime is \"\", expected require, prefer or off");
}

TEST_F(ConfigFile, RefusesAWrongTypeByNameAndLine) {
  EXPECT_EQ(refusal("rate = \"fast\""), ":1: rate is of type string, expected a number");
  EXPECT_EQ(refusal("\ndomain = 1.5"), ":2: domain is of type floating-point, expected an integer");
  EXPECT_EQ(refusal("phase_lock = 1"), ":1: phase_lock is of type integer, expected true or false");
  EXPECT_EQ(refusal("tick_cpu = 5000")
                .find(":1: tick_cpu is 5000, expected one of the CPUs that this process may use: "),
            0U);
  EXPECT_EQ(refusal("rate = true"), ":1: rate is of type boolean, expected a number");
  EXPECT_EQ(refusal("model = 3"), ":1: model is of type integer, expected a string");
  EXPECT_EQ(refusal("tool = 3"), ":1: tool is not a table");
}

TEST_F(ConfigFile, RefusesANumberOutOfRangeByNameAndLine) {
  EXPECT_EQ(refusal("domain = 231"), ":1: domain is 231, expected 0 to 230");
  EXPECT_EQ(refusal("\nrate = 9.5"), ":2: rate is 9.5, expected 10 to 10000 Hz");
  EXPECT_EQ(refusal("rate = nan"), ":1: rate is nan, expected 10 to 10000 Hz");
  EXPECT_EQ(refusal("surface_rate = 0"), ":1: surface_rate is 0, expected 0.1 to inf Hz");
  EXPECT_EQ(refusal("surface_rate = nan").find(":1: surface_rate is "), 0U);
  EXPECT_EQ(refusal("organ_id = -1"), ":1: organ_id is -1, expected 0 to 4294967295");
  EXPECT_EQ(refusal("server_id = 4294967295"), ":1: server_id is 4294967295, expected 0 to 4294967294");
}

TEST_F(ConfigFile, RefusesARateWhosePeriodDoesNotFitIntoTheStaleTimeout) {
  EXPECT_EQ(refusal("rate = 40").find(":1: rate is 40, expected at least 50 Hz"), 0U) << refusal("rate = 40");
  EXPECT_EQ(refusal("rate = 50"), "accepted");
  EXPECT_EQ(refusal("rate = 40\n[tool]\nstale_timeout = 0.025"), "accepted");
}

TEST_F(ConfigFile, RefusesAParameterOfTheEngineByNameAndLine) {
  EXPECT_EQ(refusal("domain = 1\n[tool]\ntip_radius = 0.2").find(":3: tool.tip_radius "), 0U)
      << refusal("domain = 1\n[tool]\ntip_radius = 0.2");
  EXPECT_EQ(refusal("[tool]\nforce_limit = -1.0").find(":2: tool.force_limit "), 0U);
  EXPECT_EQ(refusal("[tool]\nstale_timeout = inf").find(":2: tool.stale_timeout "), 0U);
}

TEST_F(ConfigFile, ADeviceBringsItsLimitsAndWhatIsNamedWinsInAnyOrder) {
  const ServerConfig omni = read("device = \"omni\"");
  const auto preset = findDevicePreset("omni");
  ASSERT_TRUE(preset.has_value());
  EXPECT_EQ(omni.step.force_limit, preset->force_limit);
  EXPECT_TRUE(std::isinf(omni.step.coupling_stiffness));
  EXPECT_EQ(omni.step.rendered_stiffness, preset->rendered_stiffness);
  EXPECT_EQ(omni.step.coupling_damping, preset->coupling_damping);
  const ServerConfig mixed = read("device = \"premium30\"\n[tool]\ncoupling_stiffness = 123");
  EXPECT_EQ(mixed.step.coupling_stiffness, 123.0);
  EXPECT_NEAR(mixed.step.coupling_damping, 0.615, 1e-12) << "the device's 1.5 would be too much for it";
  EXPECT_EQ(mixed.step.force_limit, findDevicePreset("premium30")->force_limit);
  const ServerConfig custom = read("device = \"custom\"");
  EXPECT_EQ(custom.step.force_limit, StepConfig{}.force_limit);
  EXPECT_TRUE(std::isinf(custom.step.coupling_stiffness));
}

TEST_F(ConfigFile, AStiffnessToRenderSoftensTheDevicesCouplingAndItsDamping) {
  const ServerConfig config = read(
      "[tool]\nrendered_stiffness = 150\n[tool.1]\ndevice = \"omni\"\n[tool.2]\nrendered_stiffness = 60\n"
      "coupling_damping = 0.1\n[tool.3]\ncoupling_stiffness = 100");
  EXPECT_EQ(config.step.rendered_stiffness, 150.0);
  EXPECT_TRUE(std::isinf(config.step.coupling_stiffness)) << "it follows the organ";
  EXPECT_NEAR(config.step.coupling_damping, 0.15, 1e-12) << "half of a touch's";
  const AllToolSettings tools = toolSettings(config.step);
  EXPECT_EQ(tools[1].rendered_stiffness, 150.0);
  EXPECT_NEAR(tools[1].live.coupling_damping, 0.9 * 150.0 / 400.0, 1e-12);
  EXPECT_EQ(tools[2].rendered_stiffness, 60.0);
  EXPECT_EQ(tools[2].live.coupling_damping, 0.1) << "named";
  EXPECT_EQ(tools[3].live.coupling_stiffness, 100.0);
  EXPECT_EQ(tools[3].rendered_stiffness, 150.0) << "both bounds hold";
  EXPECT_EQ(refusal("[tool]\nrendered_stiffness = -5")
                .find(":2: tool.rendered_stiffness is -5, expected 1 to 100000"),
            0U)
      << refusal("[tool]\nrendered_stiffness = -5");
  EXPECT_EQ(refusal("[tool.1]\nrendered_stiffness = nan").find(":2: tool.1.rendered_stiffness is nan"), 0U)
      << refusal("[tool.1]\nrendered_stiffness = nan");
}

TEST(DeviceComplaint, AStiffnessToRenderBeyondTheDevicesIsRefusedUnlessItIsCustom) {
  ServerConfig config;
  config.rendered_stiffness = 301.0;
  settleTools(config);
  const auto complaint = deviceComplaint(config);
  ASSERT_TRUE(complaint.has_value());
  EXPECT_EQ(complaint->key, "tool.rendered_stiffness");
  EXPECT_EQ(complaint->text.find("is 301, expected at most 300 N/m, what device touch is given"), 0U)
      << complaint->text;
  config.device = "custom";
  settleTools(config);
  EXPECT_FALSE(deviceComplaint(config).has_value());
  config.own[2].device = "touch";
  settleTools(config);
  EXPECT_EQ(deviceComplaint(config).value_or(Complaint{}).key, "tool.2.rendered_stiffness");
}

TEST_F(ConfigFile, TakesInfinityWhereItSwitchesOff) {
  const ServerConfig config = read(
      "device = \"custom\"\n[tool]\nfriction = inf\ncoupling_stiffness = inf\nforce_limit = inf\n"
      "force_rate_limit = inf\nspeed_limit = inf");
  for (const double value : {config.step.friction, config.step.coupling_stiffness, config.step.force_limit,
                             config.step.force_rate_limit, config.step.speed_limit})
    EXPECT_TRUE(std::isinf(value) && value > 0.0);
  EXPECT_EQ(
      refusal("[tool]\ncoupling_damping = 3").find(":2: tool.coupling_damping is 3, expected at most 1.5"),
      0U);
  EXPECT_EQ(refusal("[tool]\ncoupling_damping = inf").find(":2: tool.coupling_damping is inf"), 0U);
  EXPECT_EQ(refusal("[organ]\nyoungs_modulus = inf").find(":2: organ.youngs_modulus is inf"), 0U);
}

TEST_F(ConfigFile, RefusesWhatTheHandShouldNotFeelByNameAndLine) {
  EXPECT_EQ(refusal("[tool]\nfriction = 3").find(":2: tool.friction is 3, expected 0 to 2"), 0U);
  EXPECT_EQ(refusal("[organ]\nyoungs_modulus = 50").find(":2: organ.youngs_modulus is 50"), 0U);
  EXPECT_EQ(refusal("tools = 5").find(":1: tools is 5, expected 1 to 4"), 0U);
  EXPECT_EQ(refusal("tools = 0").find(":1: tools is 0"), 0U);
  EXPECT_EQ(refusal("\ndevice = \"falcon\""),
            ":2: device is \"falcon\", expected touch, omni, desktop, premium15, premium30, or custom");
}

TEST(DeviceComplaint, ACouplingStifferThanTheDeviceIsRefusedUnlessItIsCustom) {
  ServerConfig config;
  EXPECT_FALSE(deviceComplaint(config).has_value());
  for (const DevicePreset& preset : devicePresets()) {
    config.device = preset.name;
    config.said.coupling_stiffness = preset.stiffness_limit;
    config.step = withDevice({}, config.device, config.said);
    EXPECT_FALSE(deviceComplaint(config).has_value()) << preset.name;
    config.said.coupling_stiffness = preset.stiffness_limit + 1.0;
    config.step = withDevice({}, config.device, config.said);
    const auto complaint = deviceComplaint(config);
    ASSERT_TRUE(complaint.has_value()) << preset.name;
    EXPECT_EQ(complaint->key, "tool.coupling_stiffness");
    EXPECT_NE(complaint->text.find(config.device), std::string::npos) << complaint->text;
  }
  config.device = "custom";
  EXPECT_FALSE(deviceComplaint(config).has_value());
}

TEST_F(ConfigFile, AToolMayHaveADeviceAndValuesOfItsOwn) {
  const ServerConfig config = read(
      "device = \"touch\"\n[tool]\nfriction = 0.2\ntip_radius = 0.006\n[tool.1]\ndevice = \"premium30\"\n"
      "[tool.2]\ntip_radius = 0.004\nfriction = 0.5\n");
  const AllToolSettings tools = toolSettings(config.step);
  EXPECT_EQ(tools[0].live.force_limit, 3.3);
  EXPECT_EQ(tools[1].live.force_limit, 22.0);
  EXPECT_EQ(tools[1].live.friction, 0.2) << "what is named for all tools wins over a device";
  EXPECT_EQ(tools[1].tip_radius, 0.006);
  EXPECT_EQ(tools[2].tip_radius, 0.004);
  EXPECT_EQ(tools[2].live.friction, 0.5);
  EXPECT_EQ(tools[3], tools[0]);
  EXPECT_EQ(refusal("[tool.1]\nfriction = 3").find(":2: tool.1.friction is 3, expected 0 to 2"), 0U);
  EXPECT_EQ(refusal("[tool.1]\nyoungs_modulus = 3"), ":2: unknown key tool.1.youngs_modulus");
  EXPECT_EQ(refusal("[tool.4]\nfriction = 0.1"), ":1: unknown key tool.4");
  EXPECT_EQ(refusal("[tool.1]\ndevice = \"falcon\"").find(":2: tool.1.device is \"falcon\", expected"), 0U);
}

TEST_F(ConfigFile, TakesTheLimitsOfRequests) {
  const ServerConfig config = read(
      "parameters = \"off\"\n[limits]\nfriction = [0, 0.5]\nforce_rate_limit = [10, inf]\ntip_radius = "
      "[0.004, 0.006]");
  EXPECT_FALSE(config.parameters);
  EXPECT_EQ(config.limits.friction->high, 0.5);
  EXPECT_EQ(config.tip_limits->high, 0.006);
  EXPECT_TRUE(std::isinf(config.limits.force_rate_limit->high));
  EXPECT_FALSE(config.limits.force_limit.has_value());
  EXPECT_EQ(refusal("[limits]\nfriction = 0.5").find(":2: limits.friction is of type floating-point, "), 0U);
  EXPECT_EQ(refusal("[limits]\nfriction = [0.5]").find(":2: limits.friction is of type array, expected two"),
            0U);
  EXPECT_EQ(refusal("parameters = \"maybe\""), ":1: parameters is \"maybe\", expected on or off");
}

struct WrongLimits {
  const char* key;
  Bounds bounds;
  std::string text;
};

TEST(LimitsComplaint, NamesLimitsThatCannotBe) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const WrongLimits wrong[] = {
      {"friction", {0.5, 0.2}, "is 0.5 to 0.2, expected a range within 0 to inf"},
      {"friction", {0.0, 3.0}, "is 0 to 3, expected a range within 0 to inf"},
      {"friction", {kNaN, 1.0}, "is nan to 1, expected"},
      {"friction", {0.0, 0.2}, "is 0 to 0.2, which leaves out the start's 0.3"},
      {"force_limit", {0.0, 5.0}, "is 0 to 5 N, expected a range within 0.01 to inf N"},
      {"youngs_modulus", {100.0, std::numeric_limits<double>::infinity()}, "is 100 to inf Pa, expected"},
  };
  for (const WrongLimits& limits : wrong) {
    ServerConfig config;
    for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
      if (std::string(limits.key) == kLiveParameters[i].name)
        config.limits.*kLiveFields<LiveBounds>[i] = limits.bounds;
    const auto complaint = limitsComplaint(config);
    ASSERT_TRUE(complaint.has_value()) << limits.key << limits.text;
    EXPECT_EQ(complaint->key, std::string("limits.") + limits.key);
    EXPECT_EQ(complaint->text.find(limits.text), 0U) << complaint->text;
  }
  EXPECT_FALSE(limitsComplaint(ServerConfig{}).has_value());
}

TEST(LimitsComplaint, NamesATipThatCannotBe) {
  ServerConfig config;
  config.tip_limits = Bounds{0.004, 0.006};
  EXPECT_FALSE(limitsComplaint(config).has_value());
  for (const auto& [bounds, text] :
       {std::pair{Bounds{0.001, 0.06}, "is 0.001 to 0.06 m, expected a range within 0 to 0.05 m"},
        std::pair{Bounds{0.001, 0.004}, "is 0.001 to 0.004 m, which leaves out the start's 0.005"}}) {
    config.tip_limits = bounds;
    const auto complaint = limitsComplaint(config);
    ASSERT_TRUE(complaint.has_value()) << text;
    EXPECT_EQ(complaint->key + " " + complaint->text, std::string("limits.tip_radius ") + text);
  }
}

TEST_F(ConfigFile, RefusesAnUnknownPolicyByNameAndLine) {
  EXPECT_EQ(refusal("realtime = \"maybe\""), ":1: realtime is \"maybe\", expected require, prefer or off");
}

TEST_F(ConfigFile, RefusesASyntaxErrorByLine) {
  EXPECT_EQ(refusal("domain = 1\nrate = = 2").find(":2: "), 0U);
  EXPECT_EQ(refusal("rate = 100\nrate = 200").find(":2: "), 0U) << "a key twice";
}

TEST_F(ConfigFile, RefusesAFolderAndAMissingFile) {
  ServerConfig config;
  for (const std::string path : {"/tmp", "/nonexistent/server.toml"}) {
    try {
      readConfigFile(path, config);
      FAIL() << "accepted " << path;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.what(), path + ": cannot be read as a file");
    }
  }
}

TEST(FirstComplaint, IsAbsentForTheDefaults) {
  EXPECT_FALSE(firstComplaint(ServerConfig{}).has_value());
}

}  // namespace
}  // namespace palpate::server
