// SPDX-License-Identifier: Apache-2.0
#include "core/model/touch_patch.h"

#include <algorithm>

#include "core/base/index.h"

namespace palpate {

TouchPatch::TouchPatch(const MetaModel& model)
    : nodes_(model.patches().room()),
      weight_(kWeights * nodes_.node.size()),
      sources_(model.linearField().room(nodes_.node.size())),
      modes_(index(model.farField().modes())),
      X_(3 * kWeights * modes_),
      Z_(3 * modes_),
      near_(LinearField::unitNear(index(model.surface().nodes()), sources_)) {}

void TouchPatch::moveTo(const MetaModel& model, const ContactPoint& s) noexcept PALPATE_NONBLOCKING {
  if (s == s_) return;
  s_ = s;
  near_found_ = false;
  model.patches().at(s, true, nodes_);
  for (std::size_t j = 0; j < nodes_.count; ++j)
    Eigen::Map<Eigen::Vector4f>(weight_.data() + kWeights * j) << static_cast<float>(nodes_.weight[j]),
        nodes_.slope[j].cast<float>();
  model.farField().average(std::span(nodes_.node).first(nodes_.count), weight_, X_);
  if (!model.isDisplacementDriven()) return;
  model.linearField().find(nodes_, sources_);
  std::fill(Z_.begin(), Z_.end(), 0.0F);
  model.linearField().addUnitAmplitudes(sources_, Z_);
}

void TouchPatch::findNear(const MetaModel& model) noexcept PALPATE_NONBLOCKING {
  if (near_found_) return;
  near_found_ = true;
  model.linearField().findUnitNear(sources_, near_);
}

void TouchPatch::average(const NodeSum& u, float* out) const noexcept PALPATE_NONBLOCKING {
  mixRowsTogether({u.data(), kNodeFloats, nodes_.node.data(), nodes_.count}, weight_.data(), out);
}

}  // namespace palpate
