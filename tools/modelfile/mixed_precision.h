// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/data/packed_modes.h"
#include "tools/modelfile/model_data.h"

namespace palpate::modelfile {

/// What keeping modes in fewer bits cost.
struct StorageReport {
  ModeCounts counts;        ///< modes of each kind
  double error_limit{0.0};  ///< what was allowed, of a field's largest displacement
  double error_max{
      0.0};  ///< what it came to: largest error of a node over the largest displacement of its field
  std::size_t bytes{0};  ///< of modes that a tick reads
};

/// Rounding may cost this much of the largest displacement, however large the model's own error is: so that with what
/// is left out (kUnseenShare) and with weights that are whole numbers, 1e-3 was not reached (docs/decisions/mode_storage.md).
inline constexpr double kMostRounding = 7e-4;

/// Chooses for each mode float32 or 16, 10 or 8 bits with a scale (PackedModes), as few as keep the rounding of a
/// field under a tenth of the model's own error and under kMostRounding; measured on fields of random contacts within
/// the domain, against the modes as they are.                                         docs/design.md, Threads
/// Orders the modes by kind (modes_X and modes_Y) and fills modes_packed, which stays empty where all
/// modes need float32. @param data  complete but for these  @param own_error  of the model's fields, over the
/// displacement; 0 keeps float32. O(samples n Ns).
StorageReport storeMixed(ModelData& data, double own_error);

}  // namespace palpate::modelfile
