// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_book.h"

#include <algorithm>
#include <sstream>

#include "palpate/server/config.h"

namespace palpate::server {
namespace {

// What the operator started the server with is the ceiling, and a device's own limits where they are higher.
LiveParameters ceilings(const Facts& facts) {
  LiveParameters most = liveParameters(facts.step);
  if (const auto preset = findDevicePreset(facts.device)) {
    most.force_limit = std::max(preset->force_limit, most.force_limit);
    most.coupling_stiffness = preset->stiffness_limit;
  }
  return most;
}

LiveParameters overlaid(LiveParameters live, const dds::ParameterRequest& request) {
  const auto take = [&](std::uint32_t bit, double from, double& to) {
    if ((request.fields & bit) != 0) to = from;
  };
  take(dds::parameter::kYoungsModulus, request.youngs_modulus, live.youngs_modulus);
  take(dds::parameter::kFriction, request.friction, live.friction);
  take(dds::parameter::kCouplingStiffness, request.coupling_stiffness, live.coupling_stiffness);
  take(dds::parameter::kCouplingDamping, request.coupling_damping, live.coupling_damping);
  take(dds::parameter::kForceLimit, request.force_limit, live.force_limit);
  take(dds::parameter::kForceRateLimit, request.force_rate_limit, live.force_rate_limit);
  return live;
}

std::string tooLarge(const char* field, double value, double limit, const std::string& why) {
  if (value <= limit) return {};
  std::ostringstream text;
  text << field << " is " << value << ", expected at most " << limit << why;
  return text.str();
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
  if (std::string complaint = firstComplaint(wanted); !complaint.empty()) return complaint;
  const std::string why = "what device " + device_ + " and the start of the server allow";
  std::string complaint =
      tooLarge("coupling_stiffness", wanted.coupling_stiffness, most_.coupling_stiffness, " N/m, " + why);
  if (complaint.empty())
    complaint = tooLarge("force_limit", wanted.force_limit, most_.force_limit, " N, " + why);
  if (complaint.empty())
    complaint = tooLarge("force_rate_limit", wanted.force_rate_limit, most_.force_rate_limit, " N/s, " + why);
  return complaint;
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
  result.youngs_modulus = live_.youngs_modulus == 0.0 ? model_youngs_modulus_ : live_.youngs_modulus;
  result.friction = live_.friction;
  result.coupling_stiffness = live_.coupling_stiffness;
  result.coupling_damping = live_.coupling_damping;
  result.force_limit = live_.force_limit;
  result.force_rate_limit = live_.force_rate_limit;
  result.model_youngs_modulus = model_youngs_modulus_;
  return result;
}

}  // namespace palpate::server
