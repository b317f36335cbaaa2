// SPDX-License-Identifier: Apache-2.0
#include "core/model/touch_patch.h"

#include <algorithm>

#include "core/base/index.h"
#include "core/base/kernels.h"

namespace palpate {

TouchPatch::TouchPatch(const MetaModel& model)
    : nodes_(model.patches().room()),
      sources_(model.linearField().room(nodes_.node.size())),
      modes_(index(model.farField().modes())),
      X_(12 * modes_),
      Z_(3 * modes_) {}

void TouchPatch::moveTo(const MetaModel& model, const ContactPoint& s) noexcept PALPATE_NONBLOCKING {
  if (s == s_) return;
  s_ = s;
  model.patches().at(s, true, nodes_);
  std::fill(X_.begin(), X_.end(), 0.0F);
  std::fill(Z_.begin(), Z_.end(), 0.0F);
  const std::span<float> all = X_;
  for (std::size_t j = 0; j < nodes_.count; ++j) {
    const Vec3& slope = nodes_.slope[j];
    model.farField().addNode(nodes_.node[j], static_cast<float>(nodes_.weight[j]), all.first(3 * modes_));
    for (std::size_t k = 0; k < 3; ++k)
      model.farField().addNode(nodes_.node[j], static_cast<float>(slope[Eigen::Index(k)]),
                               all.subspan(3 * (k + 1) * modes_, 3 * modes_));
  }
  if (!model.isDisplacementDriven()) return;
  model.linearField().find(nodes_, sources_);
  for (std::size_t axis = 0; axis < 3; ++axis)
    model.linearField().addAmplitudes(sources_, Vec3::Unit(Eigen::Index(axis)),
                                      std::span(Z_).subspan(axis * modes_, modes_));
}

TouchPatch::Averages TouchPatch::ofModes(std::span<const float> y) const noexcept PALPATE_NONBLOCKING {
  std::array<float, 12> dots{};
  dotRows(X_.data(), modes_, y.data(), dots.size(), modes_, dots.data());
  Averages out;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = Eigen::Map<const Eigen::Vector3f>(dots.data() + 3 * k).cast<double>();
  return out;
}

}  // namespace palpate
