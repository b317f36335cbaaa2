// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_book.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <sstream>

#include "palpate/server/config.h"

namespace palpate::server {
namespace {

// The start's values are the ceilings; a device's own limits where they are higher.
LiveParameters ceilings(const Facts& facts) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  LiveParameters most = liveParameters(facts.step);
  most.youngs_modulus = most.friction = most.coupling_damping = kNone;
  if (const auto preset = findDevicePreset(facts.device)) {
    most.force_limit = std::max(preset->force_limit, most.force_limit);
    most.coupling_stiffness = preset->stiffness_limit;
  }
  return most;
}

LiveParameters overlaid(LiveParameters live, const dds::ParameterRequest& request) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    if ((request.fields & kLiveParameters[i].bit) != 0)
      live.*kLiveFields<LiveParameters>[i] = request.*kLiveFields<dds::ParameterRequest>[i];
  return live;
}

// What is above its ceiling; empty: nothing.
std::string tooLarge(const LiveParameters& wanted, const LiveParameters& most, const std::string& why) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const double value = wanted.*kLiveFields<LiveParameters>[i], limit = most.*kLiveFields<LiveParameters>[i];
    if (value <= limit) continue;
    std::ostringstream text;
    text << kLiveParameters[i].name << " is " << value << ", expected at most " << limit << " "
         << kLiveParameters[i].unit << ", " << why;
    return text.str();
  }
  return {};
}

}  // namespace

ParameterBook::ParameterBook(const Facts& facts)
    : server_id_(facts.server_id),
      device_(facts.device),
      model_youngs_modulus_(facts.youngs_modulus),
      most_(ceilings(facts)),
      live_(liveParameters(facts.step)) {}

std::string ParameterBook::complaintAbout(const dds::ParameterRequest& request,
                                          const LiveParameters& wanted) const {
  const std::uint32_t unknown = request.fields & ~dds::parameter::kAll;
  if (unknown != 0) return "fields has bits " + std::to_string(unknown) + " that this server does not know";
  if (const auto found = firstComplaint(wanted)) return found->sentence();
  return tooLarge(wanted, most_, "what device " + device_ + " and the start of the server allow");
}

dds::ServerParameters ParameterBook::decide(const dds::ParameterRequest& request) {
  const LiveParameters wanted = overlaid(live_, request);
  const std::string complaint = complaintAbout(request, wanted);
  if (complaint.empty() && !(wanted == live_)) {
    live_ = wanted;
    ++revision_;
  }
  dds::ServerParameters result = answer();
  result.request_id = request.request_id;
  result.accepted = complaint.empty();
  dds::assignText(result.message, complaint);
  return result;
}

dds::ServerParameters ParameterBook::answer() const {
  dds::ServerParameters result{};
  result.server_id = server_id_;
  result.accepted = true;
  result.revision = revision_;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    result.*kLiveFields<dds::ServerParameters>[i] = live_.*kLiveFields<LiveParameters>[i];
  if (live_.youngs_modulus == 0.0) result.youngs_modulus = model_youngs_modulus_;
  result.model_youngs_modulus = model_youngs_modulus_;
  return result;
}

std::string ParameterBook::describe() const {
  std::ostringstream text;
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    const double value = live_.*kLiveFields<LiveParameters>[i];
    const bool models = info.zero_is_models && value == 0.0;
    text << (i == 0 ? "" : ", ") << info.name << " " << (models ? model_youngs_modulus_ : value);
    if (*info.unit != '\0') text << " " << info.unit;
    if (models) text << " (the model's)";
  }
  return text.str();
}

}  // namespace palpate::server
