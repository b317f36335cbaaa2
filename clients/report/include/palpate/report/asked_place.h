// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palpate/client/surface.h"

namespace palpate::report {

/// The place of an option such as --at on the organ that a server serves; its distance to the surface goes to standard error.
/// @param text  "x,y,z" in m; empty: the option is absent, and so is the place
/// @throw program::ValueError  no three numbers, or farther from the surface than the contact's radius: with the distance, and the
/// unit in which it would lie on the organ
[[nodiscard]] std::optional<device::Point> askedPlace(const client::Surface& surface,
                                                      const std::string& option, const std::string& text);

/// What to say of a tool that never touched the organ: how near it came. @param nearest  of its centre to the surface, m
[[nodiscard]] std::string neverTouchedText(double nearest);

}  // namespace palpate::report
