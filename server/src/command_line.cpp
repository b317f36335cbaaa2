// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string>

namespace palpate::server {
namespace {

// What was given, apart from what the file says.
struct Given {
  std::optional<std::string> model;
  std::optional<std::string> config;
  std::optional<std::string> realtime;
  std::optional<std::int64_t> domain;
  std::optional<std::int64_t> server_id;
  std::optional<std::int64_t> organ_id;
  std::optional<std::int64_t> surface_every;
  std::optional<double> rate;
  std::optional<double> tip_radius;
  std::optional<double> force_limit;
};

void declare(CLI::App& app, Given& given) {
  app.set_version_flag("--version", std::string("palpate-server ") + PALPATE_VERSION);
  app.add_option("--model", given.model, "Model file made by palpate-solve")->type_name("FILE");
  app.add_option("--config", given.config, "Options as TOML, see server/server.toml")->type_name("FILE");
  app.add_option("--domain", given.domain, "DDS domain, 0 to 230, default 0");
  app.add_option("--rate", given.rate,
                 "Ticks per second, 50 to 10000, default 1000 (lower with a longer tool.stale_timeout)")
      ->type_name("HZ");
  app.add_option("--realtime", given.realtime, "Real-time priority: require, prefer (default) or off")
      ->type_name("POLICY");
  app.add_option("--tip-radius", given.tip_radius, "Radius of the tools' tips, m, 0 to 0.05, default 0.005");
  app.add_option("--force-limit", given.force_limit, "Largest force rendered, N, 0.01 to 50, default 3.3");
  app.add_option("--surface-every", given.surface_every, "Ticks per surface field, 1 to 1000, default 1");
  app.add_option("--organ-id", given.organ_id, "Key of the surface topics, default 0");
  app.add_option("--server-id", given.server_id, "Key of the status topic, default 0");
  app.footer(
      "Example: palpate-server --model liver.h5 --domain 7\nStop it with Ctrl-C: zero force is sent first.");
}

template <class T>
void overwrite(const std::optional<T>& given, T& value) {
  if (given) value = *given;
}

// "tool.tip_radius" is spelt --tip-radius here.
std::string optionOf(const std::string& key) {
  std::string option = key.substr(key.find('.') == std::string::npos ? 0 : key.find('.') + 1);
  std::replace(option.begin(), option.end(), '_', '-');
  return "--" + option;
}

ServerConfig combine(const Given& given) {
  ServerConfig config;
  if (given.config) readConfigFile(*given.config, config);
  if (given.model) config.model = *given.model;
  overwrite(given.domain, config.domain);
  overwrite(given.rate, config.rate);
  overwrite(given.server_id, config.server_id);
  overwrite(given.organ_id, config.organ_id);
  overwrite(given.surface_every, config.surface_every);
  overwrite(given.tip_radius, config.step.tip_radius);
  overwrite(given.force_limit, config.step.force_limit);
  try {
    if (given.realtime) config.realtime = parsePolicy(*given.realtime);
  } catch (const ConfigError& error) {
    throw ConfigError(std::string("--realtime ") + error.what());
  }
  if (const auto complaint = firstComplaint(config)) {
    throw ConfigError(optionOf(complaint->key) + " " + complaint->text);
  }
  if (config.model.empty()) throw ConfigError("--model is missing: name a model file here or in --config");
  return config;
}

}  // namespace

std::optional<ServerConfig> parseCommandLine(int argc, char** argv) {
  CLI::App app("Serves a soft organ: answers tool poses with forces and surface displacements over DDS.",
               "palpate-server");
  Given given;
  declare(app, given);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    app.exit(help, std::cout, std::cerr);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw ConfigError(error.what());
  }
  return combine(given);
}

}  // namespace palpate::server
