// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/parameter_book.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "core/devices/device_preset.h"
#include "palpate/idl/printable.h"

namespace palpate::server {
namespace {

// E by its number, where 0 stands for the model's own.
LiveParameters named(LiveParameters live, double model_youngs_modulus) {
  if (live.youngs_modulus == 0.0) live.youngs_modulus = model_youngs_modulus;
  return live;
}

// Whether a request is about a tool's value of this parameter. E is the organ's: all tools have the same.
bool sets(const dds::ParameterRequest& request, const LiveParameterInfo& info, std::size_t tool) {
  const bool meant = request.tool_id == dds::kAllTools || request.tool_id == tool;
  return (request.fields & info.bit) != 0 && (meant || info.bit == dds::parameter::kYoungsModulus);
}

AllToolSettings overlaid(AllToolSettings settings, const dds::ParameterRequest& request) {
  for (std::size_t tool = 0; tool < settings.size(); ++tool)
    for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
      if (sets(request, kLiveParameters[i], tool))
        settings[tool].live.*kLiveFields<LiveParameters>[i] = request.*kLiveFields<dds::ParameterRequest>[i];
  return settings;
}

// What a device renders, where it is less.
void cutTo(const DevicePreset& device, ToolSettings& settings) {
  LiveParameters& live = settings.live;
  settings.rendered_stiffness = std::min(settings.rendered_stiffness, device.rendered_stiffness);
  live.force_limit = std::min(live.force_limit, device.force_limit);
  live.coupling_damping =
      std::min({live.coupling_damping, device.coupling_damping,
                kLongestCouplingTime * std::min(live.coupling_stiffness, settings.rendered_stiffness)});
}

// A request does not go beyond the device either. A device that renders less than the operator's lowest still holds.
void lower(LiveLimits& limits, const LiveParameters& device) {
  for (const auto field : {&LiveParameters::force_limit, &LiveParameters::coupling_damping}) {
    limits.highest.*field = std::min(limits.highest.*field, device.*field);
    limits.lowest.*field = std::min(limits.lowest.*field, device.*field);
  }
}

// Empty: the tip that a driver names is within the operator's limits.
std::string tipComplaint(double radius, const Bounds& limits) {
  if (radius >= limits.low && radius <= limits.high) return {};
  std::ostringstream text;
  text << "tip_radius is " << radius << ", expected " << limits.low << " to " << limits.high
       << " m: what the server was started with";
  return text.str();
}

// What is beyond the operator's limits; empty: nothing.
std::string beyond(const LiveParameters& wanted, const LiveLimits& limits) {
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const auto field = kLiveFields<LiveParameters>[i];
    if (limits.lowest.*field <= wanted.*field && wanted.*field <= limits.highest.*field) continue;
    std::ostringstream text;
    text << kLiveParameters[i].name << " is " << wanted.*field << ", expected " << limits.lowest.*field
         << " to " << limits.highest.*field << " " << kLiveParameters[i].unit
         << ": what the server was started with";
    return text.str();
  }
  return {};
}

// E is the organ's: its limits follow it, those of the other parameters do not.
void setYoungsModulus(const LiveLimits& from, LiveLimits& to) {
  to.lowest.youngs_modulus = from.lowest.youngs_modulus;
  to.highest.youngs_modulus = from.highest.youngs_modulus;
}

dds::LiveValues toWire(const LiveParameters& live) {
  dds::LiveValues values{};
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    values.*kLiveFields<dds::LiveValues>[i] = live.*kLiveFields<LiveParameters>[i];
  return values;
}

}  // namespace

ParameterBook::ParameterBook(const Facts& facts)
    : server_id_(facts.server_id),
      open_(facts.parameters),
      start_youngs_modulus_(facts.step.youngs_modulus),
      bounds_(facts.limits),
      organ_(facts.organ),
      device_(facts.device),
      settings_(toolSettings(facts.step)),
      tip_limits_(facts.tip_limits) {
  for (std::size_t tool = 0; tool < settings_.size(); ++tool) {
    const LiveParameters start = named(settings_[tool].live, organ_.youngs_modulus);
    limits_[tool] = liveLimits(start, facts.limits);
    const std::string complaint = beyond(start, limits_[tool]);
    if (!complaint.empty()) throw std::invalid_argument("limits: at the start " + complaint);
    tools_[tool].start_device = device_[tool];
    tools_[tool].start = settings_[tool];
    tools_[tool].start_limits = limits_[tool];
  }
}

std::string ParameterBook::complaintAbout(const OrganStiffness& organ) const {
  LiveParameters start = tools_[0].start.live;
  start.youngs_modulus = start_youngs_modulus_;
  start = named(start, organ.youngs_modulus);
  const std::string complaint = beyond(start, liveLimits(start, bounds_));
  return complaint.empty() ? "" : "limits: with this model " + complaint;
}

AllToolSettings ParameterBook::inForceOnNext() const {
  AllToolSettings settings = settings_;
  for (ToolSettings& tool : settings) tool.live.youngs_modulus = start_youngs_modulus_;
  return settings;
}

void ParameterBook::take(const OrganStiffness& organ) {
  organ_ = organ;
  settings_ = inForceOnNext();
  for (std::size_t tool = 0; tool < settings_.size(); ++tool) {
    tools_[tool].start.live.youngs_modulus = start_youngs_modulus_;
    const LiveLimits limits = liveLimits(named(tools_[tool].start.live, organ.youngs_modulus), bounds_);
    setYoungsModulus(limits, limits_[tool]);
    setYoungsModulus(limits, tools_[tool].start_limits);
  }
  ++revision_;
}

std::string ParameterBook::complaintAbout(const dds::ParameterRequest& request,
                                          const AllToolSettings& wanted) const {
  if (request.fields != 0 && !open_) return "this server takes no parameters from clients";
  const std::uint32_t unknown = request.fields & ~dds::parameter::kAll;
  if (unknown != 0) return "fields has bits " + std::to_string(unknown) + " that this server does not know";
  if (request.tool_id >= wanted.size() && request.tool_id != dds::kAllTools)
    return "tool_id is " + std::to_string(request.tool_id) + ", expected 0 to " +
           std::to_string(wanted.size() - 1) + " or " + std::to_string(dds::kAllTools) + ", all of them";
  for (std::size_t tool = 0; tool < wanted.size(); ++tool) {
    const auto found = firstComplaint(wanted[tool]);
    const std::string text =
        found ? found->sentence() : beyond(named(wanted[tool].live, organ_.youngs_modulus), limits_[tool]);
    if (!text.empty()) return (tool == 0 ? "" : "tool " + std::to_string(tool) + ": ") + text;
  }
  return {};
}

void ParameterBook::restore(std::size_t tool) {
  const double E = settings_[tool].live.youngs_modulus;
  device_[tool] = tools_[tool].start_device;
  settings_[tool] = tools_[tool].start;
  settings_[tool].live.youngs_modulus = E;
  limits_[tool] = tools_[tool].start_limits;
}

// Sets the values that a driver names over what its device leaves. @return why not, else empty
std::string ParameterBook::overlay(const dds::ToolAnnouncement& said, const Tool& book,
                                   ToolSettings& wanted) const {
  if ((said.fields & dds::parameter::kYoungsModulus) != 0 || (said.fields & ~dds::parameter::kAll) != 0)
    return "fields is " + std::to_string(said.fields) + ", expected bits of a tool's parameters";
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i)
    if ((said.fields & kLiveParameters[i].bit) != 0)
      wanted.live.*kLiveFields<LiveParameters>[i] = said.values.*kLiveFields<dds::LiveValues>[i];
  if (!said.has_tip_radius) return {};
  wanted.tip_radius = said.tip_radius;
  return tipComplaint(said.tip_radius, tipLimits(book.start.tip_radius, tip_limits_));
}

// Takes it whole and says nothing, or says why not. A server that takes no parameters takes the device, which only lowers.
std::string ParameterBook::adopt(std::size_t tool, const dds::ToolAnnouncement& said) {
  const Tool& book = tools_[tool];
  ToolSettings wanted = book.start;
  wanted.live.youngs_modulus = settings_[tool].live.youngs_modulus;
  const std::string name(said.device, strnlen(said.device, sizeof said.device));
  const auto preset = findDevicePreset(name);
  if (!name.empty() && name != kCustomDevice && !preset)
    return "device \"" + dds::printable(name.c_str()) + "\" is not known";
  if (!(said.device_force_limit >= 0.0)) return "device_force_limit is not a number of N";
  if (preset) cutTo(*preset, wanted);
  if (said.device_force_limit > 0.0)
    wanted.live.force_limit = std::min(wanted.live.force_limit, said.device_force_limit);
  LiveLimits limits = book.start_limits;
  lower(limits, wanted.live);
  const std::string bad = open_ ? overlay(said, book, wanted) : "";
  if (!bad.empty()) return bad;
  if (const auto found = firstComplaint(wanted)) return found->sentence();
  const std::string complaint = beyond(named(wanted.live, organ_.youngs_modulus), limits);
  if (!complaint.empty()) return complaint;
  if (!name.empty()) device_[tool] = name;
  settings_[tool] = wanted;
  limits_[tool] = limits;
  return {};
}

bool ParameterBook::announced(std::size_t tool, const std::optional<DriverWord>& said) {
  Tool& book = tools_[tool];
  const std::uint64_t number = said ? said->number : 0;
  if (number == book.said) return false;
  book.said = number;
  if (book.by && (!said || said->by != *book.by)) {
    restore(tool);
    book.by.reset();
  }
  book.refusal = said ? adopt(tool, said->what) : "";
  if (said && book.refusal.empty()) book.by = said->by;
  ++revision_;
  return true;
}

dds::ServerParameters ParameterBook::decide(const dds::ParameterRequest& request) {
  const AllToolSettings wanted = overlaid(settings_, request);
  const std::string complaint = complaintAbout(request, wanted);
  if (complaint.empty() && wanted != settings_) {
    settings_ = wanted;
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
  result.model_youngs_modulus = organ_.youngs_modulus;
  result.open = open_;
  result.model_stiffness = organ_.largest;
  for (std::size_t tool = 0; tool < settings_.size(); ++tool) {
    dds::ToolParameters& out = result.tools[tool];
    dds::assignText(out.device, device_[tool]);
    out.tip_radius = settings_[tool].tip_radius;
    out.now = toWire(asFelt(settings_[tool], organ_));
    out.lowest = toWire(limits_[tool].lowest);
    out.highest = toWire(limits_[tool].highest);
    out.announced = tools_[tool].by.has_value();
    dds::assignText(out.refusal, tools_[tool].refusal);
    out.rendered_stiffness = settings_[tool].rendered_stiffness;
  }
  return result;
}

std::string ParameterBook::describe(std::size_t tool) const {
  std::ostringstream text;
  const ToolSettings& settings = settings_[tool];
  const LiveParameters live = asFelt(settings, organ_);
  text << "device " << device_[tool] << ", tip_radius " << settings.tip_radius << " m";
  for (std::size_t i = 0; i < kLiveParameters.size(); ++i) {
    const LiveParameterInfo& info = kLiveParameters[i];
    const auto field = kLiveFields<LiveParameters>[i];
    text << ", " << info.name << " " << live.*field;
    if (*info.unit != '\0') text << " " << info.unit;
    if (info.zero_is_models && settings.live.*field == 0.0) text << " (the model's)";
    if (info.bit == dds::parameter::kCouplingStiffness && followsOrgan(settings))
      text << " (with the organ at most " << settings.rendered_stiffness << " N/m)";
  }
  return text.str();
}

std::string ParameterBook::describe() const {
  std::string text = describe(0);
  for (std::size_t tool = 1; tool < settings_.size(); ++tool)
    if (settings_[tool] != settings_[0] || device_[tool] != device_[0])
      text += "; tool " + std::to_string(tool) + ": " + describe(tool);
  return text;
}

}  // namespace palpate::server
