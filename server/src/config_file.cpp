// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/config_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

namespace palpate::server {
namespace {

// Reads keys of a parsed file, remembers them, and refuses keys that were never read.
class KeyReader {
 public:
  KeyReader(const toml::table& root, std::string file) : root_(root), file_(std::move(file)) {}

  void read(const std::string& key, std::string& out) {
    readAs(key, "a string",
           [&](const toml::node& node) { return assign(node.value_exact<std::string>(), out); });
  }
  void read(const std::string& key, bool& out) {
    readAs(key, "true or false",
           [&](const toml::node& node) { return assign(node.value_exact<bool>(), out); });
  }
  void read(const std::string& key, std::int64_t& out) {
    readAs(key, "an integer",
           [&](const toml::node& node) { return assign(node.value_exact<std::int64_t>(), out); });
  }
  void read(const std::string& key, double& out) {
    readAs(key, "a number",
           [&](const toml::node& node) { return assign(node.value<double>(), out, node.is_number()); });
  }

  void read(const std::string& key, std::optional<double>& out) {
    double value = 0.0;
    read(key, value);
    if (root_.at_path(key).node() != nullptr) out = value;
  }

  void read(const std::string& key, std::optional<Bounds>& out) {
    readAs(key, "two numbers, [lowest, highest]", [&](const toml::node& node) {
      const toml::array* pair = node.as_array();
      if (pair == nullptr || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number())
        return false;
      out = Bounds{*(*pair)[0].value<double>(), *(*pair)[1].value<double>()};
      return true;
    });
  }

  [[noreturn]] void refuse(const std::string& key, const std::string& text) const {
    const toml::node* node = root_.at_path(key).node();
    const std::string line = node == nullptr ? "" : ":" + std::to_string(node->source().begin.line);
    throw ConfigError(file_ + line + ": " + key + " " + text);
  }

  void refuseUnasked() const { refuseUnaskedIn(root_, ""); }

 private:
  template <class Assign>
  void readAs(const std::string& key, const char* wanted, Assign take) {
    asked_.insert(key);
    const toml::node* node = root_.at_path(key).node();
    if (node == nullptr || take(*node)) return;
    std::ostringstream type;
    type << node->type();
    refuse(key, "is of type " + type.str() + ", expected " + wanted);
  }

  template <class T>
  static bool assign(const std::optional<T>& value, T& out, bool fits = true) {
    if (!value || !fits) return false;
    out = *value;
    return true;
  }

  // A key that was read, or a table that holds one.
  bool leadsToAnAskedKey(const std::string& key) const {
    const auto next = asked_.lower_bound(key + ".");
    return next != asked_.end() && next->rfind(key + ".", 0) == 0;
  }

  void refuseUnaskedIn(const toml::table& table, const std::string& prefix) const {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      // A quoted name may hold a dot; it looks like one of ours, but at_path() never found it.
      const bool dotted = name.str().find('.') != std::string_view::npos;
      if (!dotted && asked_.count(key) != 0) continue;
      const bool section = !dotted && leadsToAnAskedKey(key);
      if (section && node.is_table()) {
        refuseUnaskedIn(*node.as_table(), key + ".");
        continue;
      }
      const std::string line = std::to_string(name.source().begin.line);
      throw ConfigError(file_ + ":" + line + ": " +
                        (section  ? key + " is not a table"
                         : dotted ? "unknown key " + prefix + "\"" + std::string(name.str()) + "\""
                                  : "unknown key " + key));
    }
  }

  const toml::table& root_;
  std::string file_;
  std::set<std::string> asked_;
};

toml::table parseToml(const std::filesystem::path& path, const std::string& text) {
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    throw ConfigError(path.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                      std::string(error.description()));
  }
}

void readTool(KeyReader& keys, StepConfig& step) {
  keys.read("tool.tip_radius", step.tip_radius);
  keys.read("tool.stale_timeout", step.stale_timeout);
  keys.read("tool.zero_after", step.zero_after);
  keys.read("tool.ramp_time", step.ramp_time);
  keys.read("tool.quaternion_tolerance", step.quaternion_tolerance);
  keys.read("tool.speed_limit", step.speed_limit);
}

void readTools(KeyReader& keys, StepConfig& step) {
  constexpr std::int64_t kFar = 1'000'000;  // fits an int and is out of range, like all values cut to it
  std::int64_t tools = step.tools;
  keys.read("tools", tools);
  step.tools = static_cast<int>(std::clamp(tools, -kFar, kFar));
}

void readDevice(KeyReader& keys, ServerConfig& config) {
  keys.read("device", config.device);
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    keys.read(kLiveParameters[i].key, config.said.*kLiveFields<LiveOverrides>[i]);
  keys.read("tool.rendered_stiffness", config.rendered_stiffness);
}

// [tool.1]: what tool 1 has of its own.
void readOwn(KeyReader& keys, std::size_t tool, OwnOptions& own) {
  const std::string table = "tool." + std::to_string(tool) + ".";
  std::string device;
  keys.read(table + "device", device);
  if (!device.empty()) own.device = device;
  keys.read(table + "tip_radius", own.tip_radius);
  keys.read(table + "rendered_stiffness", own.rendered_stiffness);
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const std::string key = kLiveParameters[i].key;
    if (key.rfind("tool.", 0) == 0) keys.read(table + key.substr(5), own.said.*kLiveFields<LiveOverrides>[i]);
  }
}

void readLimits(KeyReader& keys, LiveBounds& limits) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    keys.read(std::string("limits.") + kLiveParameters[i].name, limits.*kLiveFields<LiveBounds>[i]);
}

// A word out of a fixed list.
template <class Take>
void takeWord(const KeyReader& keys, const char* key, Take take) {
  try {
    take();
  } catch (const ConfigError& error) {
    keys.refuse(key, error.what());
  }
}

}  // namespace

void readConfigFile(const std::filesystem::path& path, ServerConfig& config) {
  std::ifstream stream(path);
  std::ostringstream text;
  if (!std::filesystem::is_regular_file(path) || !(text << stream.rdbuf())) {
    throw ConfigError(path.string() + ": cannot be read as a file");
  }
  parseConfig(path, text.str(), config);
}

void parseConfig(const std::filesystem::path& path, const std::string& text, ServerConfig& config) {
  const toml::table root = parseToml(path, text);
  KeyReader keys(root, path.string());
  std::string model, models, security;
  std::string realtime, parameters;
  keys.read("model", model);
  keys.read("models", models);
  keys.read("domain", config.domain);
  keys.read("security", security);
  keys.read("rate", config.rate);
  keys.read("realtime", realtime);
  keys.read("parameters", parameters);
  keys.read("server_id", config.server_id);
  keys.read("addressed_only", config.addressed_only);
  keys.read("listen_first", config.listen_first);
  keys.read("organ_id", config.organ_id);
  keys.read("surface_rate", config.surface_rate);
  keys.read("phase_lock", config.phase_lock);
  keys.read("tick_cpu", config.tick_cpu);
  keys.read("tick_cpu_alone", config.tick_cpu_alone);
  readTools(keys, config.step);
  readTool(keys, config.step);
  readDevice(keys, config);
  for (std::size_t tool = 0; tool < config.own.size(); ++tool) readOwn(keys, tool, config.own[tool]);
  settleTools(config);
  readLimits(keys, config.limits);
  keys.read("limits.tip_radius", config.tip_limits);
  keys.refuseUnasked();
  if (root.contains("model")) {
    if (model.empty()) keys.refuse("model", "is empty, expected the path of a model file");
    config.model = path.parent_path() / model;
  }
  if (root.contains("models")) {
    if (models.empty()) keys.refuse("models", "is empty, expected the path of a folder");
    config.models = path.parent_path() / models;
  }
  if (root.contains("security")) {
    if (security.empty()) keys.refuse("security", "is empty, expected the path of a folder");
    config.security = path.parent_path() / security;
  }
  takeWord(keys, "realtime", [&] {
    if (root.contains("realtime")) config.realtime = parsePolicy(realtime);
  });
  takeWord(keys, "parameters", [&] {
    if (root.contains("parameters")) config.parameters = parseSwitch(parameters);
  });
  takeWord(keys, "device", [&] { checkDevice(config.device); });
  for (std::size_t tool = 0; tool < config.own.size(); ++tool)
    takeWord(keys, ("tool." + std::to_string(tool) + ".device").c_str(),
             [&] { checkDevice(deviceOf(config, tool)); });
  if (const auto complaint = firstComplaint(config)) keys.refuse(complaint->key, complaint->text);
}

}  // namespace palpate::server
