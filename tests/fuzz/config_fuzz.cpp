// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/config_file.h"
#include "targets.h"

bool palpate::fuzz::config(Bytes input) {
  server::ServerConfig config;
  try {
    server::parseConfig("folder/server.toml", std::string(input.begin(), input.end()), config);
  } catch (const server::ConfigError&) {
    return false;
  }
  require(!server::firstComplaint(config), "what is taken is in its range");
  return true;
}
