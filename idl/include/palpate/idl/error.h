// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace palpate::dds {

/// What could not be done and why, in one line. Thrown only before the loop, never while data flows.
class DdsError : public std::runtime_error {
 public:
  /// @param[in] what_failed  e.g. "cannot create a participant on domain 3"
  /// @param[in] retcode      what Cyclone DDS returned; its text is appended
  DdsError(const std::string& what_failed, std::int32_t retcode);
  /// @param[in] message  the whole line
  explicit DdsError(const std::string& message) : std::runtime_error(message) {}
};

/// Passes a handle or success through.
/// @throw DdsError when `result` is negative
std::int32_t checked(std::int32_t result, const std::string& what_failed);

}  // namespace palpate::dds
