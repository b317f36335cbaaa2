// SPDX-License-Identifier: Apache-2.0
#include "core/model/touch_field.h"

#include <algorithm>
#include <utility>

#include "core/base/index.h"
#include "core/model/near_parts.h"

namespace palpate {

namespace {

/// Of the block of a near field, kTogether vectors for each node, and a number behind them.
std::size_t sizeOf(std::size_t nodes) {
  return 3 * kTogether * nodes + 1;
}

template <std::size_t... I>
std::array<Touch, sizeof...(I)> touchesOf(const MetaModel& model, std::index_sequence<I...> /*all*/) {
  const std::size_t room = TouchField::roomFor(model);
  return {((void)I, Touch(model, room))...};
}

}  // namespace

Touches::Touches(const MetaModel& model)
    : all(touchesOf(model, std::make_index_sequence<kMaxTools>{})),
      amplitudes(index(model.farField().modes())) {}

std::size_t TouchField::roomFor(const MetaModel& model) {
  constexpr std::size_t kMost = 1U << 18U;  // a MiB
  std::size_t most = 0;
  for (std::int32_t t = 0; t < model.surface().triangles(); ++t) {
    const ContactPoint middle{t, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
    std::size_t room = 0;
    forEachNear(model, middle, fieldStencil(model, middle),
                [&](const NearPart& part) { room += sizeOf(part.field.nodes(part.source).size()); });
    most = std::max(most, room);
  }
  return std::min(most, kMost);
}

TouchField::TouchField(const MetaModel& model, std::size_t room)
    : modes_(index(model.farField().modes())),
      phi_(kTogether * modeCoefficients(model.attributes(), index(model.functions().size()))),
      kept_y_(Stencil::kMost * kTogether * modes_),
      kept_(room + sizeOf(std::max(model.nearField().blockSize(), model.edgeField().blockSize()) / 3)),
      room_(room),
      y_(kTogether * modes_),
      near_(index(model.surface().nodes())) {}

void TouchField::moveOrigin(const MetaModel& model, const Origin& origin,
                            const TouchFunctions& functions) noexcept PALPATE_NONBLOCKING {
  origin_ = origin;
  s_ = {};
  near_kept_ = false;
  const std::size_t rows = phi_.size() / kTogether;
  const std::size_t first = index(model.functions().size()) - rows;
  for (std::size_t c = 0; c < kTogether; ++c)
    for (std::size_t k = 0; k < rows; ++k)
      phi_[kTogether * k + c] = static_cast<float>(functions[c][first + k]);
  const Stencil stencil = fieldStencil(model, {origin.triangle, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}});
  std::fill_n(kept_y_.begin(), stencil.count * y_.size(), 0.0F);
  for (std::size_t b = 0; b < stencil.count; ++b)
    model.amplitudes().addTogether(stencil.position[b], phi_,
                                   std::span(kept_y_).subspan(b * y_.size(), y_.size()));
}

void TouchField::set(const MetaModel& model, const TouchPatch& from,
                     const Vec3& d) noexcept PALPATE_NONBLOCKING {
  s_ = from.s();
  d_ = d;
  near_found_ = false;
  stencil_ = fieldStencil(model, s_);
  std::fill(y_.begin(), y_.end(), 0.0F);
  for (std::size_t b = 0; b < stencil_.count; ++b)
    addScaled(kept_y_.data() + b * y_.size(), static_cast<float>(stencil_.weight[b]), y_);
  const std::span<float> u = std::span(y_).first(modes_);
  const Vec3 beyond = d_ - origin_.d;
  for (std::size_t i = 0; i < 3; ++i)
    addScaled(y_.data() + (i + 1) * modes_, static_cast<float>(beyond[Eigen::Index(i)]), u);
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
  near_.clear();
  std::size_t begin = 0;
  forEachNear(model, s_, stencil_, [&](const NearPart& part) noexcept PALPATE_NONBLOCKING {
    const std::span<const std::int32_t> nodes = part.field.nodes(part.source);
    const std::size_t size = sizeOf(nodes.size());
    const bool fits = begin + size <= room_;
    const std::span<float> block = std::span(kept_).subspan(fits ? begin : room_, size);
    if (!fits || !near_kept_)
      part.field.findTogether(part.source, std::span(phi_).first(kTogether * part.rows), block);
    if (fits) begin += size;
    near_.reach(nodes);
    addVectors(block.data(), nodes.data(), nodes.size(), static_cast<float>(part.weight), near_.data());
  });
  near_kept_ = true;
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
      const NodeSum::Vectors bend = NodeSum::vectorsOf(near.data() + kNodeFloats * k);
      motion.by[k] += bend;
      motion.by[k].col(0) += bend.rightCols<3>() * (d_ - origin_.d);
    }
  }
  if (!model.isDisplacementDriven() || apart > 2.0 * model.reachOfPatches() + model.linearField().reach())
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
  std::copy_n(y_.begin(), modes_, scratch.begin());
  for (std::size_t i = 0; i < 3; ++i)
    addScaled(y_.data() + (i + 1) * modes_, static_cast<float>(y[Eigen::Index(i)]), scratch);
  const double apart = model.surface().distanceToNodes(point.triangle, model.surface().position(s_));
  const bool bends = apart <= reach_;
  const bool loaded =
      model.isDisplacementDriven() && apart <= model.reachOfPatches() + model.linearField().reach();
  if (bends) findNear(model);
  if (loaded) from.findNear(model);
  const Vec3 beyond = d_ - origin_.d + y;
  Vec3 f = load_[0], u = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) f += y[Eigen::Index(i)] * load_[i + 1];
  const NodeMix nodes = model.surface().nodesAt(point);
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 there = model.farField().at(scratch, nodes.node[k]);
    if (bends) {
      const NodeSum::Vectors bend = near_.at(nodes.node[k]);
      there += bend.col(0) + bend.rightCols<3>() * beyond;
    }
    if (loaded) there += from.near().at(nodes.node[k]).leftCols<3>() * f;
    u += nodes.weight[k] * there;
  }
  return u;
}

}  // namespace palpate
