// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate {

inline constexpr int kMaxTools = 4;  ///< that one organ answers

}  // namespace palpate
