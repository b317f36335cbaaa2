// SPDX-License-Identifier: Apache-2.0
#include "palpate/core/tool_coupling.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "load_driven.h"
#include "palpate/core/workspace.h"

namespace palpate {

namespace {

constexpr int kMost = 3 * kMaxTools;
/// Unknowns of all tools, and the matrix between them; no allocation.
using Numbers = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;

std::size_t index(std::int64_t i) noexcept {
  return static_cast<std::size_t>(i);
}

/// P_to of the near field. Where no near node lies in the patch no block is evaluated.
Vec3 averagedNear(const MetaModel& model, const PositionMix& from, std::span<const double> phi, double gain,
                  const PositionMix& to, std::span<float> scratch) noexcept {
  const NearField& near = model.nearField();
  const std::span<float> weight = scratch.last(index(model.surface().nodes()));
  const auto positions = std::span(from.position).first(index(from.count));
  const auto meets = [&](std::int32_t b) noexcept { return model.patchAverage().meets(b, to); };
  if (std::none_of(positions.begin(), positions.end(), meets)) return Vec3::Zero();
  for (const std::int32_t b : positions)
    for (const std::int32_t node : near.nodes(b)) weight[index(node)] = 0.0F;  // no other is read
  model.patchAverage().addWeights(to, weight);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const auto weighs = [&](std::int32_t node) noexcept { return weight[index(node)] > 0.0F; };
    const std::span<const std::int32_t> nodes = near.nodes(positions[k]);
    if (std::none_of(nodes.begin(), nodes.end(), weighs)) continue;
    const NearField::Block block = near.block(positions[k], phi, gain * from.weight[k], scratch);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sum += weight[index(nodes[i])] * Eigen::Map<const Eigen::Vector3f>(block.u.data() + 3 * i);
  }
  return sum.cast<double>();
}

/// P_to of the field sum_alpha phi_alpha U_alpha.
Vec3 averaged(const MetaModel& model, const PositionMix& from, std::span<const double> phi, double gain,
              const PositionMix& to, FieldScratch& scratch) noexcept {
  std::fill(scratch.amplitudes.begin(), scratch.amplitudes.end(), 0.0F);
  model.farField().addAmplitudes(from, phi, gain, scratch.amplitudes);
  return model.patchAverage().ofModes(to, scratch.amplitudes) +
         averagedNear(model, from, phi, gain, to, scratch.near_block);
}

/// The tools' own parts as the root of  x_A + sum_B P_A u_B(x_B) = d_A.
class Coupling {
 public:
  Coupling(const MetaModel& model, std::span<const ContactPoint> s, FieldScratch& scratch) noexcept
      : model_(model), s_(s), scratch_(scratch), size_(static_cast<Eigen::Index>(3 * s.size())) {}

  /// x + what the others add.
  [[nodiscard]] Numbers moved(const Numbers& x) noexcept {
    Numbers sum = x;
    for (Eigen::Index b = 0; b < size_; b += 3) addTo(sum, b, x.segment<3>(b), 1.0);
    return sum;
  }

  /// Its derivative at rest. @param h  length of the differences that stand for it in a load-driven model, m
  [[nodiscard]] Table slopeAtRest(double h) noexcept {
    Table slope = Table::Identity(size_, size_);
    for (Eigen::Index b = 0; b < size_; ++b) {
      Numbers column = Numbers::Zero(size_);
      if (model_.attributes().parameters == Parameters::kDisplacement)
        addLinearTo(column, b);
      else
        addTo(column, b - b % 3, h * Vec3::Unit(b % 3), 1.0 / h);
      slope.col(b) += column;
    }
    return slope;
  }

 private:
  /// What tool b (its first unknown) moves the others by.
  void addTo(Numbers& sum, Eigen::Index b, const Vec3& d, double factor) noexcept {
    const FieldSource source = ownPart(model_, s_[index(b / 3)], d);
    for (Eigen::Index a = 0; a < size_; a += 3)
      if (a != b) sum.segment<3>(a) += factor * patchDisplacement(model_, source, s_[index(a / 3)], scratch_);
  }

  /// What unknown b moves the others by, per m: the coefficients of degree 1 alone, which come first.
  void addLinearTo(Numbers& sum, Eigen::Index b) noexcept {
    const PositionMix from = model_.surface().mix(s_[index(b / 3)]);
    if (from.count == 0) return;
    std::array<double, MonomialBasis::kMaxCoefficients> all{};
    const std::span<double> phi(all.data(), index(model_.functions().size()));
    phi[index(b % 3)] = 1.0 / model_.functions().reference();
    for (Eigen::Index a = 0; a < size_; a += 3) {
      const PositionMix to = model_.surface().mix(s_[index(a / 3)]);
      if (a != b - b % 3 && to.count > 0) sum.segment<3>(a) += averaged(model_, from, phi, 1.0, to, scratch_);
    }
  }

  const MetaModel& model_;
  std::span<const ContactPoint> s_;
  FieldScratch& scratch_;
  Eigen::Index size_;
};

/// Makes the slope right along dx, where it is known to give dy (Broyden).
void learn(Table& slope, const Numbers& dx, const Numbers& dy) noexcept {
  const double square = dx.squaredNorm();
  if (square > 0.0) slope += (dy - slope * dx) * (dx.transpose() / square);
}

/// The step that leaves least of r, at a price for its length: tools that touch the same place cannot be moved
/// apart.
Numbers damped(const Table& slope, const Numbers& r) noexcept {
  constexpr double kDamping = 0.01;
  Table normal = slope.transpose() * slope;
  normal.diagonal().array() += kDamping * kDamping;
  return normal.ldlt().solve(Numbers(slope.transpose() * r));
}

}  // namespace

Vec3 patchDisplacement(const MetaModel& model, const FieldSource& source, const ContactPoint& at,
                       FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  const PositionMix from = model.surface().mix(source.s), to = model.surface().mix(at);
  if (from.count == 0 || to.count == 0) return Vec3::Zero();
  std::array<double, MonomialBasis::kMaxCoefficients> all;
  const std::span<double> phi(all.data(), index(model.functions().size()));
  model.functions().evaluate(clampToDomain(source.parameter, model.response().limit(from)), phi);
  return averaged(model, from, phi, source.gain, to, scratch);
}

FieldSource ownPart(const MetaModel& model, const ContactPoint& s,
                    const Vec3& d) noexcept PALPATE_NONBLOCKING {
  Response response;
  const ResponseStatus status = respond(model, s, d, response);
  FieldSource source{s, response.parameter, 1.0};
  const double answered = response.displacement.norm();
  if (status == ResponseStatus::kClamped && answered > 0.0 &&
      model.attributes().parameters != Parameters::kLevel)
    source.gain = d.norm() / answered;
  return source;  // without an answer its parameter is zero, and so is the field
}

double ownDisplacements(const MetaModel& model, std::span<const ContactPoint> s, std::span<const Vec3> d,
                        int iterations, FieldScratch& scratch,
                        std::span<Vec3> own) noexcept PALPATE_NONBLOCKING {
  const std::size_t tools = std::min<std::size_t>(s.size(), kMaxTools);
  if (tools < 2) std::copy(d.begin(), d.end(), own.begin());
  Numbers x(static_cast<Eigen::Index>(3 * tools)), wanted(x.size());
  double length = 0.0;
  for (std::size_t a = 0; a < tools; ++a) {
    x.segment<3>(static_cast<Eigen::Index>(3 * a)) = own[a];
    wanted.segment<3>(static_cast<Eigen::Index>(3 * a)) = d[a];
    length = std::max({length, d[a].norm(), own[a].norm()});
  }
  if (tools < 2 || length == 0.0) return 0.0;
  Coupling coupling(model, s.first(tools), scratch);
  Table slope = coupling.slopeAtRest(0.01 * length);
  Numbers left = wanted - coupling.moved(x);
  learn(slope, x, wanted - left);
  for (int i = 0; i < iterations; ++i) {
    const Numbers step = damped(slope, left);
    x += step;
    const Numbers now = wanted - coupling.moved(x);
    learn(slope, step, left - now);
    left = now;
  }
  double most = 0.0;
  for (std::size_t a = 0; a < tools; ++a) {
    own[a] = x.segment<3>(static_cast<Eigen::Index>(3 * a));
    most = std::max(most, left.segment<3>(static_cast<Eigen::Index>(3 * a)).norm());
  }
  return most;
}

}  // namespace palpate
