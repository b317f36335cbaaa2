// SPDX-License-Identifier: Apache-2.0
#include "core/model/touch_field.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/base/index.h"
#include "core/model/near_parts.h"

namespace palpate {

namespace {

template <std::size_t... I>
std::array<Touch, sizeof...(I)> touchesOf(const MetaModel& model, std::index_sequence<I...> /*all*/) {
  return {((void)I, Touch(model))...};
}

/// Of the functions those that modes and near fields have, side by side. @param phi  [Cm][kTogether]
void storeLast(const TouchFunctions& functions, std::size_t size,
               std::span<float> phi) noexcept PALPATE_NONBLOCKING {
  const std::size_t rows = phi.size() / kTogether;
  for (std::size_t c = 0; c < kTogether; ++c)
    for (std::size_t k = 0; k < rows; ++k)
      phi[kTogether * k + c] = static_cast<float>(functions[c][size - rows + k]);
}

}  // namespace

Touches::Touches(const MetaModel& model)
    : all(touchesOf(model, std::make_index_sequence<kMaxTools>{})),
      amplitudes(index(model.farField().modes())) {}

TouchField::TouchField(const MetaModel& model)
    : modes_(index(model.farField().modes())),
      functions_(index(model.functions().size())),
      rows_(modeCoefficients(model.attributes(), functions_)),
      row_(rows_),
      Y_(rows_ * modes_),
      phi_(kTogether * rows_),
      y_(kTogether * modes_),
      near_(index(model.surface().nodes())),
      block_(kTogether * std::max(model.nearField().blockSize(), model.edgeField().blockSize()) + 1) {
  std::iota(row_.begin(), row_.end(), 0);
}

void TouchField::set(const MetaModel& model, const TouchPatch& from, const Vec3& d, double step,
                     const TouchFunctions& functions) noexcept PALPATE_NONBLOCKING {
  if (!(s_ == from.s())) {
    s_ = from.s();
    stencil_ = fieldStencil(model, s_);
    std::fill(Y_.begin(), Y_.end(), 0.0F);
    model.amplitudes().addRows(std::span(stencil_.position).first(stencil_.count), stencil_.weight.data(),
                               Y_);
  }
  d_ = d;
  step_ = step;
  near_found_ = false;
  storeLast(functions, functions_, phi_);
  mixRowsTogether({Y_.data(), modes_, row_.data(), rows_}, phi_.data(), y_.data());
  const Vec3 X = model.surface().position(s_);
  reach_ = 0.0;
  forEachNear(model, s_, stencil_, [&](const NearPart& part) noexcept PALPATE_NONBLOCKING {
    reach_ = std::max(reach_, (part.centre - X).norm() + part.reach);
  });
  if (!model.isDisplacementDriven()) return;
  PatchStiffness::Value stiffness;
  model.stiffness().at(model.surface(), s_, stiffness);
  for (std::size_t c = 0; c < kTogether; ++c) {
    load_[c] = c == 0 ? Vec3(stiffness.K * d) : Vec3(stiffness.K.col(Eigen::Index(c) - 1));
    for (std::size_t axis = 0; axis < 3; ++axis)
      addScaled(from.load(axis).data(), static_cast<float>(load_[c][Eigen::Index(axis)]),
                std::span(y_).subspan(c * modes_, modes_));
  }
}

void TouchField::findNear(const MetaModel& model) noexcept PALPATE_NONBLOCKING {
  if (near_found_) return;
  near_found_ = true;
  near_.zero();
  const bool elsewhere = reached_ != s_.triangle;
  if (elsewhere) near_.clear();
  reached_ = stencil_.count > 0 ? s_.triangle : -1;  // where no position answers nothing is reached
  forEachNear(model, s_, stencil_, [&](const NearPart& part) noexcept PALPATE_NONBLOCKING {
    const std::span<const std::int32_t> nodes = part.field.nodes(part.source);
    if (elsewhere) near_.reach(nodes);
    part.field.findTogether(part.source, std::span(phi_).first(kTogether * part.rows), block_);
    addVectors(block_.data(), nodes.data(), nodes.size(), static_cast<float>(part.weight), near_.data());
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
  const double apart = (model.surface().position(s_) - model.surface().position(to.s())).norm();
  std::array<float, TouchPatch::kWeights * kNodeFloats> near{};
  if (apart <= reach_ + model.reachOfPatches()) {
    findNear(model);
    to.average(near_, near.data());
    for (std::size_t k = 0; k < motion.by.size(); ++k) {
      motion.by[k] += NodeSum::vectorsOf(near.data() + kNodeFloats * k);
    }
  }
  if (!model.isDisplacementDriven() || apart > 2.0 * model.reachOfPatches() + model.linearField().reach())
    return motion;
  from.findNear(model);
  to.average(from.near().sum, near.data());
  for (std::size_t k = 0; k < motion.by.size(); ++k) {
    const Mat3 unit = Eigen::Map<const Eigen::Matrix3f>(near.data() + kNodeFloats * k).cast<double>();
    for (std::size_t c = 0; c < kTogether; ++c) motion.by[k].col(Eigen::Index(c)) += unit * load_[c];
  }
  return motion;
}

Vec3 TouchField::at(const MetaModel& model, TouchPatch& from, const Vec3& y, const ContactPoint& point,
                    std::span<float> scratch) noexcept PALPATE_NONBLOCKING {
  std::copy_n(y_.begin(), modes_, scratch.begin());
  for (std::size_t i = 0; i < 3; ++i)
    addScaled(y_.data() + (i + 1) * modes_, static_cast<float>(y[Eigen::Index(i)]), scratch);
  model.farField().weigh(scratch);
  const double apart = model.surface().distanceToNodes(point.triangle, model.surface().position(s_));
  const bool bends = apart <= reach_;
  const bool loaded =
      model.isDisplacementDriven() && apart <= model.reachOfPatches() + model.linearField().reach();
  if (bends) findNear(model);
  if (loaded) from.findNear(model);
  Vec3 f = load_[0], u = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) f += y[Eigen::Index(i)] * load_[i + 1];
  const NodeMix nodes = model.surface().nodesAt(point);
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 there = model.farField().at(scratch, nodes.node[k]);
    if (bends) {
      const NodeSum::Vectors bend = near_.at(nodes.node[k]);
      there += bend.col(0) + bend.rightCols<3>() * y;
    }
    if (loaded) there += from.near().at(nodes.node[k]) * f;
    u += nodes.weight[k] * there;
  }
  return u;
}

}  // namespace palpate
