// SPDX-License-Identifier: Apache-2.0
#include "core/model/touch_field.h"

#include <algorithm>

#include "core/base/index.h"
#include "core/model/near_parts.h"

namespace palpate {

TouchField::TouchField(const MetaModel& model)
    : modes_(index(model.farField().modes())),
      phi_(kTogether * modeCoefficients(model.attributes(), index(model.functions().size()))),
      y_(kTogether * modes_),
      near_(index(model.surface().nodes())),
      block_(kTogether * std::max(model.nearField().blockSize(), model.edgeField().blockSize()) + 1) {}

void TouchField::set(const MetaModel& model, const TouchPatch& from,
                     const TouchFunctions& functions) noexcept PALPATE_NONBLOCKING {
  s_ = from.s();
  near_found_ = false;
  stencil_ = fieldStencil(model, s_);
  const std::size_t rows = phi_.size() / kTogether;
  const std::size_t first = index(model.functions().size()) - rows;
  for (std::size_t c = 0; c < kTogether; ++c)
    for (std::size_t k = 0; k < rows; ++k)
      phi_[kTogether * k + c] = static_cast<float>(functions[c][first + k]);
  std::fill(y_.begin(), y_.end(), 0.0F);
  for (std::size_t b = 0; b < stencil_.count; ++b)
    model.amplitudes().addTogether(stencil_.position[b], phi_, stencil_.weight[b], y_);
  const Vec3 X = model.surface().position(s_);
  reach_ = 0.0;
  forEachNear(model, s_, stencil_, [&](const NearPart& part) noexcept PALPATE_NONBLOCKING {
    reach_ = std::max(reach_, (part.centre - X).norm() + part.reach);
  });
  if (!model.isDisplacementDriven()) return;
  PatchStiffness::Value stiffness;
  model.stiffness().at(model.surface(), s_, stiffness);
  for (std::size_t c = 0; c < kTogether; ++c) {
    load_[c] = model.functions().reference() * (stiffness.K * Eigen::Map<const Vec3>(functions[c].data()));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::span<const float> unit = from.load(axis);
      const auto f = static_cast<float>(load_[c][Eigen::Index(axis)]);
      for (std::size_t k = 0; k < modes_; ++k) y_[c * modes_ + k] += f * unit[k];
    }
  }
}

void TouchField::findNear(const MetaModel& model) noexcept PALPATE_NONBLOCKING {
  if (near_found_) return;
  near_found_ = true;
  near_.clear();
  forEachNear(model, s_, stencil_, [&](const NearPart& part) noexcept PALPATE_NONBLOCKING {
    part.field.addTogether(part.source, std::span(phi_).first(kTogether * part.rows), part.weight, block_,
                           near_);
  });
}

PatchMotion TouchField::on(const MetaModel& model, TouchPatch& from,
                           const TouchPatch& to) noexcept PALPATE_NONBLOCKING {
  PatchMotion motion;
  std::array<float, 3 * TouchPatch::kWeights> dots{};
  for (std::size_t c = 0; c < kTogether; ++c) {
    dotRows(to.modes(), modes_, y_.data() + c * modes_, dots.size(), modes_, dots.data());
    for (std::size_t k = 0; k < motion.by.size(); ++k)
      motion.by[k].col(Eigen::Index(c)) =
          Eigen::Map<const Eigen::Vector3f>(dots.data() + 3 * k).cast<double>();
  }
  const double apart = (model.surface().position(from.s()) - model.surface().position(to.s())).norm();
  std::array<float, TouchPatch::kWeights * kNodeFloats> near{};
  if (apart <= reach_ + model.reachOfPatches()) {
    findNear(model);
    to.average(near_, near.data());
    for (std::size_t k = 0; k < motion.by.size(); ++k)
      motion.by[k] += NodeSum::vectorsOf(near.data() + kNodeFloats * k);
  }
  if (!model.isDisplacementDriven() ||
      apart > 2.0 * model.reachOfPatches() + model.linearField().reach())
    return motion;
  from.findNear(model);
  to.average(from.near(), near.data());
  for (std::size_t k = 0; k < motion.by.size(); ++k) {
    const Mat3 unit = NodeSum::vectorsOf(near.data() + kNodeFloats * k).leftCols<3>();
    for (std::size_t c = 0; c < kTogether; ++c) motion.by[k].col(Eigen::Index(c)) += unit * load_[c];
  }
  return motion;
}

Vec3 TouchField::at(const MetaModel& model, TouchPatch& from, const Vec3& y, const ContactPoint& point,
                    std::span<float> scratch) noexcept PALPATE_NONBLOCKING {
  const Eigen::Vector4d share(1.0, y.x(), y.y(), y.z());
  std::fill(scratch.begin(), scratch.end(), 0.0F);
  for (std::size_t c = 0; c < kTogether; ++c) {
    const auto weight = static_cast<float>(share[Eigen::Index(c)]);
    for (std::size_t k = 0; k < modes_; ++k) scratch[k] += weight * y_[c * modes_ + k];
  }
  const NodeMix nodes = model.surface().nodesAt(point);
  const double apart = model.surface().distanceToNodes(point.triangle, model.surface().position(s_));
  const bool bends = apart <= reach_, loaded = model.isDisplacementDriven() &&
                                               apart <= model.reachOfPatches() + model.linearField().reach();
  if (bends) findNear(model);
  if (loaded) from.findNear(model);
  Vec3 f = Vec3::Zero(), u = Vec3::Zero();
  for (std::size_t c = 0; loaded && c < kTogether; ++c) f += share[Eigen::Index(c)] * load_[c];
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 there = model.farField().at(scratch, nodes.node[k]);
    if (bends) there += near_.at(nodes.node[k]) * share;
    if (loaded) there += from.near().at(nodes.node[k]).leftCols<3>() * f;
    u += nodes.weight[k] * there;
  }
  return u;
}

}  // namespace palpate
