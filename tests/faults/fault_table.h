// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace palpate::faults {

/// What a fault did to the force at the tool, and what came after it.
struct Outcome {
  std::string fault;
  std::optional<double> zero_ms;  ///< from the fault to a force of zero; none: the force went on
  double largest{0.0};   ///< size of the force from the fault until it was right again, beside that of before
  double smallest{0.0};  ///< the same
  std::optional<double> again_ms;  ///< from the fault's end until the force was right again; none: it was not
  std::optional<double> recording_lacks_ms;  ///< at its end; none: nothing was recorded, or all of it
};

/// Prints a row, and keeps it for the file that PALPATE_FAULTS_JSON names.
void tell(const Outcome& outcome);

}  // namespace palpate::faults
