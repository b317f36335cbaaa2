// SPDX-License-Identifier: Apache-2.0
#include "core/model/contact_dimple.h"

#include <algorithm>
#include <utility>

namespace palpate {

/// The whole field at places, by the functions that it is a sum of.
class ContactDimple::FieldThere {
 public:
  explicit FieldThere(const Parts& parts)
      : modes_(parts.view.modes()),
        patch_(parts.patches.room()),
        sources_(parts.linear.room(patch_.node.size())),
        y_(modes_),
        X_(3 * modes_),
        Z_(3 * modes_),
        made_(parts.places.size(), 0) {
    bend_.reserve(parts.rows);  // a page's ticks have no room to fail
  }

  /// Marks a place as made. @return whether it was already
  bool isMade(std::size_t place) noexcept { return std::exchange(made_[place], std::uint8_t{1}) != 0; }

  /// @param[out] u  rows, of three numbers each, m
  void at(const Parts& parts, std::size_t place, std::size_t rows, float* u) {
    const ContactPoint& s = parts.places.views(place).front().s;
    nodes_ = parts.surface.nodesAt(s);
    std::fill(X_.begin(), X_.end(), 0.0F);
    for (std::size_t k = 0; k < 3; ++k)
      if (nodes_.weight[k] > 0.0)
        parts.modes.addNode(nodes_.node[k], static_cast<float>(nodes_.weight[k]), X_);
    for (std::size_t axis = 0; axis < 3; ++axis)
      parts.modes.weigh(std::span(X_).subspan(axis * modes_, modes_));
    PatchStiffness::Value stiffness;
    parts.stiffness.at(parts.surface, s, stiffness);
    const Mat3 linear = compliance(parts, s) * (parts.reference * stiffness.K);
    for (Eigen::Index axis = 0; axis < 3; ++axis) store(linear.col(axis), u + 3 * axis);
    bend(parts, place, s, rows - kLinearCoefficients);
    for (std::size_t row = kLinearCoefficients; row < rows; ++row)
      store(bend_[row - kLinearCoefficients], u + 3 * row);
  }

 private:
  static void store(const Vec3& from, float* to) { Eigen::Map<Eigen::Vector3f>{to} = from.cast<float>(); }

  /// The place's displacement by unit loads on its patch, column by load, m/N.
  [[nodiscard]] Mat3 compliance(const Parts& parts, const ContactPoint& s) {
    using Columns = Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, 3>>;
    parts.patches.at(s, false, patch_);
    parts.linear.find(patch_, sources_);
    std::fill(Z_.begin(), Z_.end(), 0.0F);
    parts.linear.addUnitAmplitudes(sources_, Z_);
    const Columns X(X_.data(), Eigen::Index(modes_), 3), Z(Z_.data(), Eigen::Index(modes_), 3);
    Mat3 u = X.transpose().lazyProduct(Z).cast<double>();
    for (std::size_t k = 0; k < 3; ++k)
      if (nodes_.weight[k] > 0.0) u += nodes_.weight[k] * parts.linear.nearAt(sources_, nodes_.node[k]);
    return u;
  }

  /// Finds the first rows beyond the linear ones.
  void bend(const Parts& parts, std::size_t place, const ContactPoint& s, std::size_t rows) {
    const Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, 3>> X(X_.data(), Eigen::Index(modes_), 3);
    const Eigen::Map<const Eigen::VectorXf> y(y_.data(), Eigen::Index(modes_));
    bend_.resize(rows);
    if (rows == 0) return;
    Stencil stencil = parts.mixing.at(parts.surface, s);
    std::size_t count = 0;  // at a position all others have none
    for (std::size_t b = 0; b < stencil.count; ++b) {
      if (stencil.weight[b] == 0.0) continue;
      stencil.position[count] = stencil.position[b];
      stencil.weight[count++] = stencil.weight[b];
    }
    for (std::size_t row = 0; row < rows; ++row) {
      std::fill(y_.begin(), y_.end(), 0.0F);
      for (std::size_t b = 0; b < count; ++b)
        parts.amplitudes.addRow(stencil.position[b], row, stencil.weight[b], y_);
      bend_[row] = (X.transpose() * y).cast<double>();
    }
    for (std::size_t b = 0; b < count; ++b) addNear(parts.near, stencil.position[b], stencil.weight[b]);
    if (place >= parts.view.positions())
      addNear(parts.edges, static_cast<std::int32_t>(place - parts.view.positions()), 1.0);
  }

  void addNear(const NearField& near, std::int32_t source, double factor) {
    for (std::size_t k = 0; k < 3; ++k)
      if (nodes_.weight[k] > 0.0) near.addRowsAt(source, factor * nodes_.weight[k], nodes_.node[k], bend_);
  }

  std::size_t modes_;
  PatchNodes patch_;
  PatchSources sources_;
  NodeMix nodes_{};
  std::vector<float> y_;            // [n]
  std::vector<float> X_;            // [3][n]
  std::vector<float> Z_;            // [3][n] of unit loads, m/N
  std::vector<Vec3> bend_;          // rows beyond the linear ones, m
  std::vector<std::uint8_t> made_;  // [P]
};

ContactDimple::ContactDimple() = default;
ContactDimple::~ContactDimple() = default;
ContactDimple::ContactDimple(ContactDimple&&) noexcept = default;
ContactDimple& ContactDimple::operator=(ContactDimple&&) noexcept = default;

ContactDimple::ContactDimple(const Parts& parts, DimpleTable made)
    : positions_(parts.view.positions()),
      rows_(parts.rows),
      edge_rows_(kLinearCoefficients + parts.edge_rows),
      position_(positions_ * 3 * rows_),
      edge_((parts.places.size() - positions_) * 3 * edge_rows_),
      field_(std::make_unique<FieldThere>(parts)) {
  if (made == DimpleTable::kWhenTouched) return;
  for (std::size_t place = 0; place < parts.places.size(); ++place) make(parts, place);
  field_.reset();
}

/// A position, or an edge whose ends are made.
void ContactDimple::make(const Parts& parts, std::size_t place) const {
  if (field_->isMade(place)) return;
  if (place < positions_) return field_->at(parts, place, rows_, position_.data() + 3 * rows_ * place);
  float* const beyond = edge_.data() + 3 * edge_rows_ * (place - positions_);
  field_->at(parts, place, edge_rows_, beyond);
  const ContactPoint& s = parts.places.views(place).front().s;
  const std::array<std::int32_t, 6>& corner = parts.places.of(s.triangle);
  for (std::size_t k = 0; k < 3; ++k)
    if (s.barycentric[k] > 0.0)
      for (std::size_t i = 0; i < 3 * edge_rows_; ++i) beyond[i] -= 0.5F * ofPosition(corner[k])[i];
}

/// What at() reads.
void ContactDimple::makeAround(const Parts& parts, const PositionMix& mix,
                               const std::array<std::int32_t, 6>& place) const {
  for (std::size_t b = 0; b < index(mix.count); ++b) make(parts, index(mix.position[b]));
  if (place[0] < 0) return;
  for (const std::int32_t each : place) make(parts, index(each));
}

Vec3 ContactDimple::at(const Parts& parts, const ContactPoint& s, const PositionMix& mix,
                       std::span<const double> phi) const noexcept PALPATE_NONBLOCKING {
  const std::array<std::int32_t, 6>& place = parts.places.of(s.triangle);
  PALPATE_TRUSTED_BEGIN
  if (field_) makeAround(parts, mix, place);  // in a page, which has no other thread
  PALPATE_TRUSTED_END
  Vec3 u = Vec3::Zero();
  const auto add = [&](const float* table, std::size_t rows, double weight) noexcept PALPATE_NONBLOCKING {
    for (std::size_t k = 0; k < rows; ++k)
      u += weight * phi[k] * Eigen::Map<const Eigen::Vector3f>(table + 3 * k).cast<double>();
  };
  for (std::size_t b = 0; b < index(mix.count); ++b) add(ofPosition(mix.position[b]), rows_, mix.weight[b]);
  for (std::size_t k = 0; k < 3 && place[0] >= 0; ++k)
    add(ofEdge(place[3 + k]), edge_rows_, 4.0 * s.barycentric[(k + 1) % 3] * s.barycentric[(k + 2) % 3]);
  return u;
}

}  // namespace palpate
