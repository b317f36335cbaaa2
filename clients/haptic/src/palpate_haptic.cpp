// SPDX-License-Identifier: Apache-2.0
// The C interface: checks pointers, turns exceptions into text and states into codes.
#include "palpate_haptic.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include "palpate/haptic/haptic_tool.h"

struct palpate_haptic {
  palpate::haptic::HapticTool tool;
};

namespace {

using palpate::haptic::Force;
using palpate::haptic::Options;

Options optionsOf(const palpate_haptic_options& from) {
  return {from.domain,
          from.server_id,
          from.tool_id,
          from.force_limit,
          from.max_extrapolation,
          from.receive_priority,
          from.device == nullptr ? "" : from.device,
          from.organ_id == PALPATE_HAPTIC_ANY_ORGAN ? std::nullopt : std::optional(from.organ_id),
          from.security == nullptr ? "" : from.security};
}

void tell(std::string_view text, char* error, std::size_t error_size) noexcept {
  if (error == nullptr || error_size == 0) return;
  const std::size_t size = std::min(text.size(), error_size - 1);
  std::memcpy(error, text.data(), size);
  error[size] = '\0';
}

template <std::size_t N>
std::array<double, N> arrayOf(const double* values) noexcept {
  std::array<double, N> result;
  std::copy_n(values, N, result.begin());
  return result;
}

int hand(const Force& force, palpate_haptic_force& out) noexcept {
  std::copy(force.force.begin(), force.force.end(), out.force);
  std::copy(force.anchor.begin(), force.anchor.end(), out.anchor);
  std::copy(force.proxy.begin(), force.proxy.end(), out.proxy);
  out.age_s = force.age_s;
  out.gain = force.gain;
  out.pose_seq = force.pose_seq;
  out.flags = force.flags;
  out.state = force.state;
  out.server_id = force.server_id;
  out.session = force.session;
  return force.age_s >= 0.050 ? PALPATE_HAPTIC_NO_ANSWER : PALPATE_HAPTIC_OK;
}

}  // namespace

extern "C" {

void palpate_haptic_default_options(palpate_haptic_options* options) {
  if (options == nullptr) return;
  const Options defaults;
  *options = {defaults.domain,
              defaults.server_id,
              defaults.tool_id,
              defaults.force_limit,
              defaults.max_extrapolation,
              defaults.receive_priority,
              nullptr,
              PALPATE_HAPTIC_ANY_ORGAN,
              nullptr};
}

palpate_haptic* palpate_haptic_open(const palpate_haptic_options* options, char* error, size_t error_size) {
  try {
    tell("", error, error_size);
    if (options == nullptr) throw palpate::haptic::HapticError("no options: force_limit has no default");
    return new palpate_haptic{palpate::haptic::HapticTool(optionsOf(*options))};
  } catch (const std::exception& failure) {
    tell(failure.what(), error, error_size);
  } catch (...) {
    tell("unknown error", error, error_size);
  }
  return nullptr;
}

void palpate_haptic_close(palpate_haptic* tool) {
  delete tool;
}

int palpate_haptic_wait_for_server(const palpate_haptic* tool, double seconds) {
  if (tool == nullptr || !(seconds >= 0.0 && seconds <= 3600.0)) return PALPATE_HAPTIC_INVALID_ARGUMENT;
  const auto timeout = std::chrono::milliseconds(std::llround(seconds * 1e3));
  return tool->tool.waitForServer(timeout) ? PALPATE_HAPTIC_OK : PALPATE_HAPTIC_NO_SERVER;
}

int palpate_haptic_send(palpate_haptic* tool, const double position[3], const double orientation[4],
                        uint32_t buttons) {
  if (tool == nullptr || position == nullptr) return PALPATE_HAPTIC_INVALID_ARGUMENT;
  const palpate::haptic::Quaternion turned =
      orientation == nullptr ? palpate::haptic::Quaternion{0.0, 0.0, 0.0, 1.0} : arrayOf<4>(orientation);
  return tool->tool.send(arrayOf<3>(position), turned, buttons) != 0 ? PALPATE_HAPTIC_OK
                                                                     : PALPATE_HAPTIC_SEND_FAILED;
}

int palpate_haptic_read(palpate_haptic* tool, palpate_haptic_force* out) {
  if (tool == nullptr || out == nullptr) return PALPATE_HAPTIC_INVALID_ARGUMENT;
  return hand(tool->tool.force(), *out);
}

int palpate_haptic_read_at(palpate_haptic* tool, const double position[3], palpate_haptic_force* out) {
  if (tool == nullptr || position == nullptr || out == nullptr) return PALPATE_HAPTIC_INVALID_ARGUMENT;
  return hand(tool->tool.forceAt(arrayOf<3>(position)), *out);
}

uint64_t palpate_haptic_left_out(const palpate_haptic* tool) {
  return tool == nullptr ? 0 : tool->tool.leftOut();
}

uint64_t palpate_haptic_too_late(const palpate_haptic* tool) {
  return tool == nullptr ? 0 : tool->tool.tooLate();
}

double palpate_haptic_nearest(const palpate_haptic* tool) {
  return tool == nullptr ? std::numeric_limits<double>::infinity() : tool->tool.nearest();
}

double palpate_haptic_tip_radius(const palpate_haptic* tool) {
  return tool == nullptr ? 0.0 : tool->tool.tipRadius();
}

double palpate_haptic_server_force_limit(const palpate_haptic* tool) {
  return tool == nullptr ? 0.0 : tool->tool.serverForceLimit();
}

void palpate_haptic_security_warning(const palpate_haptic* tool, char* text, size_t size) {
  tell("", text, size);
  if (tool == nullptr) return;
  try {
    tell(tool->tool.securityWarning(), text, size);
  } catch (...) {  // no memory for a line: none is told
  }
}

const char* palpate_haptic_error_text(int code) {
  switch (code) {
    case PALPATE_HAPTIC_OK:
      return "ok";
    case PALPATE_HAPTIC_NO_ANSWER:
      return "no force from the server: none yet, or none for 50 ms";
    case PALPATE_HAPTIC_INVALID_ARGUMENT:
      return "a null pointer, or a number out of its range";
    case PALPATE_HAPTIC_SEND_FAILED:
      return "DDS refused the pose, or no server of the organ is known";
    case PALPATE_HAPTIC_NO_SERVER:
      return "no server takes poses and sends forces on this domain";
    default:
      return "unknown code";
  }
}

}  // extern "C"
