// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::program {

/// What a model's certificate says, in one line for people; of an empty one that there is none. docs/design.md, Certificate
/// @param certificate  ModelAttributes::certificate, any text
[[nodiscard]] std::string certificateLine(const std::string& certificate);

}  // namespace palpate::program
