// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/facts.h"

#include <unistd.h>

#include <array>
#include <random>

#include "core/model/meta_model.h"
#include "core/response/largest_stiffness.h"
#include "palpate/server/config.h"

namespace palpate::server {
namespace {

std::uint64_t newSession() {
  std::random_device random;
  std::uint64_t session = 0;
  while (session == 0) session = static_cast<std::uint64_t>(random()) << 32 | random();
  return session;
}

std::string hostName() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

}  // namespace

Facts factsOf(const MetaModel& model, const ServerConfig& config) {
  Facts facts;
  facts.server_id = static_cast<std::uint32_t>(config.server_id);
  facts.session = newSession();
  facts.answers_any = !config.addressed_only;
  facts.host = hostName();
  facts.pid = static_cast<std::uint32_t>(getpid());
  facts.model_id = model.id();
  facts.model_hash = model.contentHash();
  facts.organ_id = static_cast<std::uint32_t>(config.organ_id);
  facts.rate_hz = config.rate;
  for (std::size_t tool = 0; tool < facts.device.size(); ++tool) facts.device[tool] = deviceOf(config, tool);
  facts.step = config.step;
  facts.organ = {model.attributes().E, largestStiffness(model)};
  facts.step.organ_stiffness = facts.organ.largest;
  facts.parameters = config.parameters;
  facts.limits = config.limits;
  facts.tip_limits = config.tip_limits;
  return facts;
}

}  // namespace palpate::server
