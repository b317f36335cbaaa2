// SPDX-License-Identifier: Apache-2.0
#include "core/tick/shown_surface.h"

#include <algorithm>
#include <utility>

#include "core/base/kernels.h"

namespace palpate {

ShownSurface::ShownSurface(const MetaModel& model)
    : model_(model),
      scratch_(model),
      displacement_(3 * static_cast<std::size_t>(model.surface().nodes())),
      from_(displacement_.size()) {}

bool ShownSurface::show(const SurfaceState& state) noexcept PALPATE_NONBLOCKING {
  if (std::exchange(jumps_, state.jumps) != state.jumps) {
    blends_ = in_sight_ && state.blend > 0.0;
    if (blends_) std::copy(displacement_.begin(), displacement_.end(), from_.begin());
  }
  in_sight_ = true;
  const float weight = blends_ ? static_cast<float>(state.blend) : 0.0F;
  if (weight == 0.0F && pure_ && sources_ == state.sources) return false;
  sources_ = state.sources;
  pure_ = weight == 0.0F;
  overflowed_ = !evaluate();
  if (!pure_) mixInto(from_, weight, displacement_);  // no difference, which may overflow
  return true;
}

/// @return false when the model overflows: the field is zero then
bool ShownSurface::evaluate() noexcept PALPATE_NONBLOCKING {
  const bool moved = !sources_.all().empty();
  if (moved) evaluateField(model_, sources_.all(), scratch_, displacement_);
  if (moved && allFinite(displacement_)) return true;
  std::fill(displacement_.begin(), displacement_.end(), 0.0F);
  return !moved;
}

}  // namespace palpate
