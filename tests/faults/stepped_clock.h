// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::faults {

/// What the library stepped_clock writes to standard error when the clock is first read that it has stepped.
inline constexpr char kReadAhead[] = "the wall clock is an hour ahead\n";

}  // namespace palpate::faults
