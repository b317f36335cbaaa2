// SPDX-License-Identifier: Apache-2.0
#include "core/response/tool_coupling.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "core/base/index.h"
#include "core/model/clamp_to_domain.h"
#include "core/response/small_square.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

namespace {

/// P_to of the near field. Where no near node lies in the patch no block is evaluated.
Vec3 averagedNear(const MetaModel& model, const PositionMix& from, std::span<const double> phi, double gain,
                  const PositionMix& to, std::span<float> scratch) noexcept PALPATE_NONBLOCKING {
  const NearField& near = model.nearField();
  const std::span<float> weight = scratch.last(index(model.surface().nodes()));
  const auto positions = std::span(from.position).first(index(from.count));
  const auto meets = [&](std::int32_t b) noexcept PALPATE_NONBLOCKING {
    return model.patchAverage().meets(b, to);
  };
  if (std::none_of(positions.begin(), positions.end(), meets)) return Vec3::Zero();
  for (const std::int32_t b : positions)
    for (const std::int32_t node : near.nodes(b)) weight[index(node)] = 0.0F;  // no other is read
  model.patchAverage().addWeights(to, weight);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const auto weighs = [&](std::int32_t node) noexcept PALPATE_NONBLOCKING {
      return weight[index(node)] > 0.0F;
    };
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
              const PositionMix& to, FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  std::fill(scratch.amplitudes.begin(), scratch.amplitudes.end(), 0.0F);
  model.farField().addAmplitudes(from, phi, gain, scratch.amplitudes);
  return model.patchAverage().ofModes(to, scratch.amplitudes) +
         averagedNear(model, from, phi, gain, to, scratch.near_block);
}

/// What one tool moves the others' patches by, and its derivative. The organ is asked once, however many others there are.
class Influence {
 public:
  Influence(const MetaModel& model, const ContactPoint& s, const Vec3& d,
            double h) noexcept PALPATE_NONBLOCKING : model_(model),
                                                     s_(s),
                                                     d_(d),
                                                     h_(h),
                                                     own_(ownPart(model, s, d)) {
    const bool displaced = model.attributes().parameters == Parameters::kDisplacement;
    if (displaced) differentiate();
    for (std::size_t i = 0; !displaced && i < 3; ++i)
      beside_[i] = ownPart(model, s, d + h * Vec3::Unit(static_cast<Eigen::Index>(i)));
  }

  /// P_at u(s, d), m.
  [[nodiscard]] Vec3 on(const ContactPoint& at, FieldScratch& scratch) const noexcept PALPATE_NONBLOCKING {
    return patchDisplacement(model_, own_, at, scratch);
  }

  /// P_at du/dd, 3 x 3; of a load-driven model by differences of length h. @param moved  on(at)
  [[nodiscard]] Mat3 slopeOn(const ContactPoint& at, const Vec3& moved,
                             FieldScratch& scratch) const noexcept PALPATE_NONBLOCKING {
    const PositionMix from = model_.surface().mix(s_), to = model_.surface().mix(at);
    Mat3 slope = Mat3::Zero();
    if (from.count == 0 || to.count == 0) return slope;
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (model_.attributes().parameters == Parameters::kDisplacement) {
        const std::span<const double> phi(slope_[index(i)].data(), index(model_.functions().size()));
        slope.col(i) = averaged(model_, from, phi, 1.0, to, scratch);
      } else {
        slope.col(i) = (patchDisplacement(model_, beside_[index(i)], at, scratch) - moved) / h_;
      }
    }
    return slope;
  }

 private:
  void differentiate() noexcept PALPATE_NONBLOCKING {
    const PositionMix from = model_.surface().mix(s_);
    std::array<Vec3, MonomialBasis::kMaxCoefficients> all;
    const std::span<Vec3> gradient(all.data(), index(model_.functions().size()));
    model_.functions().gradient(clampToDomain(d_, model_.response().limit(from)), gradient);
    for (std::size_t k = 0; k < gradient.size(); ++k)
      for (std::size_t i = 0; i < 3; ++i)
        slope_[i][k] = gradient[k][static_cast<Eigen::Index>(i)] / model_.functions().reference();
  }

  const MetaModel& model_;
  const ContactPoint& s_;
  const Vec3& d_;
  double h_;
  FieldSource own_;
  std::array<FieldSource, 3> beside_;  // at d + h e_i, of a load-driven model
  std::array<std::array<double, MonomialBasis::kMaxCoefficients>, 3> slope_;  // dphi/dd_i
};

/// Points half a patch's width from one, two of them across: to and from along each tangent.
std::array<ContactPoint, 4> surround(const MetaModel& model,
                                     const ContactPoint& at) noexcept PALPATE_NONBLOCKING {
  const double h = 0.5 * model.attributes().patch_radius;
  const Mat32 tangent = model.surface().frame(at).tangent;
  std::array<ContactPoint, 4> ends{at, at, at, at};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Vec3 way = (i % 2 == 0 ? h : -h) * tangent.col(static_cast<Eigen::Index>(i / 2));
    (void)model.surface().move(ends[i], way, Reach::kAccessible);
  }
  return ends;
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

Mat3 patchDisplacementSlope(const MetaModel& model, std::span<const FieldSource> sources,
                            const ContactPoint& at, FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  const auto ends = surround(model, at);
  std::array<Vec3, 4> u;
  std::fill(u.begin(), u.end(), Vec3(Vec3::Zero()));
  std::fill(scratch.amplitudes.begin(), scratch.amplitudes.end(), 0.0F);
  std::array<double, MonomialBasis::kMaxCoefficients> all;
  const std::span<double> phi(all.data(), index(model.functions().size()));
  for (const FieldSource& source : sources) {
    const PositionMix from = model.surface().mix(source.s);
    if (from.count == 0) continue;
    model.functions().evaluate(clampToDomain(source.parameter, model.response().limit(from)), phi);
    model.farField().addAmplitudes(from, phi, source.gain, scratch.amplitudes);
    for (std::size_t i = 0; i < ends.size(); ++i)
      u[i] += averagedNear(model, from, phi, source.gain, model.surface().mix(ends[i]), scratch.near_block);
  }
  for (std::size_t i = 0; i < ends.size(); ++i)
    u[i] += model.patchAverage().ofModes(model.surface().mix(ends[i]), scratch.amplitudes);
  Mat32 way, change;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const auto to = static_cast<std::size_t>(2 * k);
    way.col(k) = model.surface().position(ends[to]) - model.surface().position(ends[to + 1]);
    change.col(k) = u[to] - u[to + 1];
  }
  const Mat2 square = way.transpose() * way;
  const double least = 1e-3 * square.trace() * square.trace();
  if (!(square.determinant() > least)) return Mat3::Zero();  // in a corner of the accessible part
  return change * square.inverse() * way.transpose();
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

void ownDisplacements(const MetaModel& model, std::span<const ContactPoint> s, std::span<const Vec3> d,
                      FieldScratch& scratch, std::span<Vec3> own,
                      InfluenceTable* influence) noexcept PALPATE_NONBLOCKING {
  const std::size_t tools = std::min<std::size_t>(s.size(), kMaxTools);
  std::copy(d.begin(), d.end(), own.begin());
  if (influence != nullptr)
    for (auto& row : *influence) row.fill(Mat3::Zero());
  double length = 0.0;
  for (const Vec3& prescribed : d) length = std::max(length, prescribed.norm());
  if (tools < 2 || length == 0.0) return;
  SmallSquare slope(tools);
  std::array<Vec3, kMaxTools> moved;
  for (std::size_t a = 0; a < tools; ++a) moved[a].setZero();
  for (std::size_t b = 0; b < tools; ++b) {
    const Influence of(model, s[b], d[b], 0.01 * length);
    for (std::size_t a = 0; a < tools; ++a) {
      if (a == b) continue;
      const Vec3 u = of.on(s[a], scratch);
      moved[a] += u;
      slope.setPart(a, b, of.slopeOn(s[a], u, scratch));
    }
  }
  const SmallSquare inverse = dampedInverse(slope);
  for (std::size_t a = 0; a < tools; ++a)
    for (std::size_t b = 0; b < tools; ++b) own[a] -= inverse.part(a, b) * moved[b];
  if (influence == nullptr) return;
  slope.subtractUnit();
  const SmallSquare carried = product(inverse, slope);  // e = inverse moved
  for (std::size_t a = 0; a < tools; ++a)
    for (std::size_t b = 0; b < tools; ++b) (*influence)[a][b] = carried.part(a, b);
}

std::array<FieldSource, 2> ownField(const MetaModel& model, const ContactPoint& s, const Vec3& d,
                                    const Vec3& own) noexcept PALPATE_NONBLOCKING {
  constexpr double kStep = 0.002;  // of the domain: short against it, long against rounding
  const Vec3 y = own - d;
  Response there;
  (void)respond(model, s, d, there);
  const double share = std::min(1.0, kStep * there.domain_radius / std::max(y.norm(), 1e-30));
  if (!(share > 0.0)) return {ownPart(model, s, d), FieldSource{s, Vec3::Zero(), 0.0}};
  std::array<FieldSource, 2> part{ownPart(model, s, d), ownPart(model, s, d + share * y)};
  part[0].gain *= 1.0 - 1.0 / share;
  part[1].gain /= share;
  return part;
}

}  // namespace palpate
