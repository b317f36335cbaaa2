// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "command_words.h"
#include "palpate/server/config_file.h"
#include "palpate/server/live_limits.h"
#include "palpate/server/models_folder.h"
#include "tools/program/command_line.h"
#include "tools/program/installed.h"
#include "tools/program/write_file.h"

namespace palpate::server {
namespace {

// What the command line names.
struct Given {
  std::optional<std::string> model;
  std::optional<std::string> models;
  std::optional<std::string> config;
  std::optional<std::string> record;
  std::optional<std::string> realtime;
  std::optional<std::int64_t> domain;
  std::optional<std::string> security;
  std::optional<std::int64_t> server_id;
  std::optional<bool> addressed_only;
  std::optional<double> listen_first;
  std::optional<std::int64_t> organ_id;
  std::optional<std::int64_t> tools;
  std::optional<double> rate;
  std::optional<double> surface_rate;
  std::optional<bool> phase_lock;
  std::optional<std::int64_t> tick_cpu;
  std::optional<bool> tick_cpu_alone;
  std::optional<double> tip_radius;
  std::optional<double> speed_limit;
  std::optional<std::string> device;
  std::vector<std::string> own;
  LiveOverrides live;
  std::optional<double> rendered_stiffness;
  std::optional<std::string> parameters;
  std::vector<std::string> limits;
  bool check_realtime{false};
  bool json{false};
};

// What holds where neither the file nor the command line names a value.
std::string defaultOf(std::size_t parameter) {
  double StepConfig::*const field = kLiveFields<StepConfig>[parameter];
  StepConfig of_device;
  of_device.*field = std::numeric_limits<double>::quiet_NaN();
  apply(*findDevicePreset(kDefaultDevice), of_device);
  if (!std::isnan(of_device.*field)) return "the device's";
  std::ostringstream text;
  text << StepConfig{}.*field;
  return text.str();
}

void declareContact(program::Options line, Given& given) {
  line.add("--device", &given.device,
           "Device whose limits hold: touch (default), omni, desktop, premium15, premium30 or custom")
      .valueName("NAME");
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    line.add(info.option, &(given.live.*kLiveFields<LiveOverrides>[i]),
             std::string(info.help) + ", default " + defaultOf(i));
  }
  line.add("--rendered-stiffness", &given.rendered_stiffness,
           "Organ and coupling in series render at most this, N/m, 1 to 1e5, default and most the device's; "
           "its damping goes down in proportion");
  line.add("--tool", &given.own,
           "What one tool has of its own: device, tip-radius, friction, coupling, rendered-stiffness, "
           "coupling-damping, force-limit, force-rate-limit, e.g. --tool 1:device=omni,tip-radius=0.004")
      .oneWordEach()
      .valueName("ID:NAME=VALUE,...");
  line.add("--parameters", &given.parameters,
           "Whether clients may change these while it runs: on (default) or off")
      .valueName("SWITCH");
  line.add("--limit", &given.limits,
           "Lowest and highest value that a client may set, e.g. --limit friction=0:0.5; by default the "
           "start's value is the "
           "highest")
      .oneWordEach()
      .valueName("NAME=LOW:HIGH");
  line.add("--speed-limit", &given.speed_limit,
           "A pose that moves faster counts as a jump, m/s, 0.01 to 100 or inf, default 2");
  line.add("--tools", &given.tools, "Number of tools that are answered, ids from 0; 1 to 4, default 4");
}

void declare(program::Options line, Given& given) {
  line.add("--model", &given.model, "Model file made by palpate-solve").valueName("FILE");
  line.add(
          "--models", &given.models,
          "Folder whose model files clients may ask for while it runs (palpate-parameters --model); default: "
          "none, and they may not")
      .valueName("FOLDER");
  line.add("--config", &given.config,
           "Options as TOML; all of them with their defaults: " +
               program::installedText(PALPATE_CONFIG_FROM_BIN))
      .valueName("FILE");
  line.add("--record", &given.record,
           "Record every tick's input and answer in this file, for palpate-replay; another organ goes to "
           "session-2.rec beside session.rec, at most 1000 files; the size is not bounded")
      .valueName("FILE");
  line.add("--domain", &given.domain, "DDS domain, 0 to 230, default 0");
  line.add("--security", &given.security,
           "Folder with this server's identity (palpate-security issue), where topics are signed and "
           "encrypted; "
           "default: they are not")
      .valueName("FOLDER");
  line.add("--rate", &given.rate,
           "Ticks per second, 50 to 10000, default 1000 (lower with a longer tool.stale_timeout)")
      .valueName("HZ");
  line.add("--realtime", &given.realtime, "Real-time priority: require, prefer (default) or off")
      .valueName("POLICY");
  line.add("--tip-radius", &given.tip_radius, "Radius of the tools' tips, m, 0 to 0.05, default 0.005");
  declareContact(line, given);
  line.add("--surface-rate", &given.surface_rate,
           "Most surface fields per second, 0.1 or more, default 1000; inf: one with every tick that changes "
           "it")
      .valueName("HZ");
  line.flag("--phase-lock,!--no-phase-lock", &given.phase_lock,
            "Ticks follow the poses' arrival, so that a pose waits little for its tick");
  line.flag("--check-realtime", &given.check_realtime,
            "Say how kernel, CPUs, interrupts, limits and sleep states suit a punctual tick, and how to "
            "better it; then "
            "end; with --realtime require by 3 where the priority would be refused");
  line.flag("--json", &given.json, "With --check-realtime: print one JSON object on standard output");
  line.add("--tick-cpu", &given.tick_cpu,
           "CPU that the tick runs on, default -1: where the scheduler puts it");
  line.flag("--tick-cpu-alone,!--no-tick-cpu-alone", &given.tick_cpu_alone,
            "Nothing else of the server runs on the tick's CPU");
  line.add("--organ-id", &given.organ_id, "Key of the surface topics, default 0");
  line.add("--server-id", &given.server_id, "Names this server in poses and answers, default 0");
  line.flag("--addressed-only,!--no-addressed-only", &given.addressed_only,
            "Answers only poses that name this server, so that several may share a domain");
  line.add("--listen-first", &given.listen_first,
           "How long to listen for other servers before the first force, s, 0 to 10, default 0.5; 0: not at "
           "all")
      .valueName("S");
}

template <class T>
void overwrite(const std::optional<T>& given, T& value) {
  if (given) value = *given;
}

// "tool.tip_radius" is spelt --tip-radius here.
std::string optionOf(const std::string& key) {
  for (const LiveParameterInfo& info : kLiveParameters)
    if (key == info.key) return info.option;
  for (const LiveParameterInfo& info : kLiveParameters)
    if (key == std::string("limits.") + info.name) return std::string("--limit ") + &info.option[2];
  if (key == "limits.tip_radius") return std::string("--limit ") + kTipRadius;
  if (key.size() > 6 && key.rfind("tool.", 0) == 0 && key[6] == '.')
    return std::string("--tool ") + key[5] + ":" + optionOf("tool." + key.substr(7)).substr(2);
  std::string option = key.substr(key.find('.') == std::string::npos ? 0 : key.find('.') + 1);
  std::replace(option.begin(), option.end(), '_', '-');
  return "--" + option;
}

// What the command line or the file names wins over the device preset.
void combineDevice(const Given& given, ServerConfig& config) {
  overwrite(given.device, config.device);
  for (const auto field : kLiveFields<LiveOverrides>)
    if (given.live.*field) config.said.*field = given.live.*field;
  if (given.rendered_stiffness) config.rendered_stiffness = given.rendered_stiffness;
}

void combineContact(const Given& given, StepConfig& step) {
  constexpr std::int64_t kFar = 1'000'000;  // fits an int and is out of range, like all values cut to it
  overwrite(given.tip_radius, step.tip_radius);
  overwrite(given.speed_limit, step.speed_limit);
  if (given.tools) step.tools = static_cast<int>(std::clamp(*given.tools, -kFar, kFar));
}

template <class Take>
void takeWord(const char* option, Take take) {
  try {
    take();
  } catch (const ConfigError& error) {
    throw ConfigError(std::string(option) + " " + error.what());
  }
}

// A value out of range on the command line; the file was checked when it was read.
void refuse(const Complaint& complaint) {
  throw ConfigError(optionOf(complaint.key) + " " + complaint.text);
}

ServerConfig combine(const Given& given) {
  ServerConfig config;
  if (given.config) readConfigFile(*given.config, config);
  if (given.model) config.model = *given.model;
  if (given.models) config.models = *given.models;
  if (given.models && given.models->empty())
    throw ConfigError("--models is empty, expected the path of a folder");
  if (!config.models.empty()) (void)ModelsFolder(config.models);  // it can be opened
  if (given.record) config.record = *given.record;
  if (given.record && given.record->empty())
    throw ConfigError("--record is empty, expected the path of a file");
  if (given.record) program::checkOutput("--record", *given.record);
  overwrite(given.domain, config.domain);
  if (given.security) config.security = *given.security;
  if (given.security && given.security->empty())
    throw ConfigError("--security is empty, expected the path of a folder");
  overwrite(given.rate, config.rate);
  overwrite(given.server_id, config.server_id);
  overwrite(given.addressed_only, config.addressed_only);
  overwrite(given.listen_first, config.listen_first);
  overwrite(given.organ_id, config.organ_id);
  overwrite(given.surface_rate, config.surface_rate);
  overwrite(given.phase_lock, config.phase_lock);
  overwrite(given.tick_cpu, config.tick_cpu);
  overwrite(given.tick_cpu_alone, config.tick_cpu_alone);
  combineContact(given, config.step);
  combineDevice(given, config);
  for (const std::string& word : given.own) takeTool(word, config.own);
  settleTools(config);
  takeWord("--realtime", [&] {
    if (given.realtime) config.realtime = parsePolicy(*given.realtime);
  });
  takeWord("--parameters", [&] {
    if (given.parameters) config.parameters = parseSwitch(*given.parameters);
  });
  for (const std::string& word : given.limits) takeLimit(word, config);
  takeWord("--device", [&] { checkDevice(config.device); });
  for (std::size_t tool = 0; tool < config.own.size(); ++tool)
    takeWord("--tool", [&] { checkDevice(deviceOf(config, tool)); });
  if (const auto complaint = firstComplaint(config)) refuse(*complaint);
  if (const auto complaint = deviceComplaint(config)) refuse(*complaint);
  if (const auto complaint = limitsComplaint(config)) refuse(*complaint);
  if (config.tick_cpu_alone && config.tick_cpu == kAnyCpu)
    throw ConfigError("--tick-cpu-alone without --tick-cpu: which CPU is it?");
  config.check_realtime = given.check_realtime;
  config.json = given.json;
  if (config.json && !config.check_realtime) throw ConfigError("--json is for --check-realtime");
  if (config.model.empty() && !config.check_realtime)
    throw ConfigError("--model is missing: name a model file here or in --config");
  return config;
}

}  // namespace

std::optional<ServerConfig> parseCommandLine(int argc, char** argv) {
  program::CommandLine line(
      "palpate-server",
      "Serves a soft organ: answers tool poses with forces and surface displacements over DDS.",
      std::string("palpate-server ") + PALPATE_VERSION);
  Given given;
  declare(line.options(), given);
  line.footer(
      "Example: palpate-server --model liver.h5 --domain 7\nStop it with Ctrl-C: zero force is sent first.");
  try {
    if (!line.read(argc, argv)) return std::nullopt;
  } catch (const program::UsageError& error) {
    throw ConfigError(error.what());
  }
  return combine(given);
}

}  // namespace palpate::server
