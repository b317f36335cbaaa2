// SPDX-License-Identifier: Apache-2.0
#include "core/response/tool_coupling.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "core/base/index.h"
#include "core/response/small_square.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

namespace {

/// Whether a near field may reach a patch.
bool meets(const MetaModel& model, const NearPart& part, const TouchPatch& to) noexcept PALPATE_NONBLOCKING {
  return model.surface().distanceToNodes(to.s().triangle, part.centre) <= model.reachOfPatches() + part.reach;
}

/// What modes and near fields of positions move a patch by, orders of two and more of a "displacement" model, everything of the
/// others: its average, and that by the weights' slopes. @param phi  functions of these
TouchPatch::Averages averaged(const MetaModel& model, const ContactPoint& s, std::span<const double> phi,
                              const TouchPatch& to, FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  const Stencil from = fieldStencil(model, s);
  std::fill(scratch.amplitudes.begin(), scratch.amplitudes.end(), 0.0F);
  for (std::size_t b = 0; b < from.count; ++b)
    model.amplitudes().add(from.position[b], phi, from.weight[b], scratch.amplitudes);
  TouchPatch::Averages sum = to.ofModes(scratch.amplitudes);
  if (phi.empty()) return sum;
  const PatchNodes& nodes = to.nodes();
  for (std::size_t j = 0; j < nodes.count; ++j)
    scratch.weight[index(nodes.node[j])] << static_cast<float>(nodes.weight[j]), nodes.slope[j].cast<float>();
  const auto weighs = [&](std::int32_t node) noexcept PALPATE_NONBLOCKING {
    return scratch.weight[index(node)][0] > 0.0F;
  };
  const auto addBlock = [&](const NearPart& part) noexcept PALPATE_NONBLOCKING {
    if (!meets(model, part, to)) return;
    const std::span<const std::int32_t> list = part.field.nodes(part.source);
    if (std::none_of(list.begin(), list.end(), weighs)) return;
    const NearField::Block block = part.field.block(part.source, part.phi, part.weight, scratch.near_block);
    Eigen::Matrix<float, 3, 4> near = Eigen::Matrix<float, 3, 4>::Zero();
    for (std::size_t i = 0; i < list.size(); ++i)
      near += Eigen::Map<const Eigen::Vector3f>(block.u.data() + 3 * i) *
              scratch.weight[index(list[i])].transpose();
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += near.col(Eigen::Index(k)).cast<double>();
  };
  forEachNear(model, s, from, phi, addBlock);
  for (std::size_t j = 0; j < nodes.count; ++j) scratch.weight[index(nodes.node[j])].setZero();
  return sum;
}

using Compliance = std::array<Mat3, 4>;

/// What a source of a field does to a patch elsewhere, and how that changes as the patch moves: by lambda.
/// @param compliance  complianceBetween() the two of a "displacement" model, else unused
TouchPatch::Averages movedBy(const MetaModel& model, const FieldSource& source, const TouchPatch& to,
                             const Compliance& compliance,
                             FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  TouchPatch::Averages moved;
  for (Vec3& part : moved) part.setZero();
  const PositionMix from = model.surface().mix(source.s);
  if (from.count == 0 || to.nodes().count == 0) return moved;
  std::array<double, MonomialBasis::kMaxCoefficients> all;
  const auto size = index(model.functions().size());
  const Vec3 p =
      fieldFunctions(model, source.parameter, model.response().limit(from), std::span(all).first(size));
  moved = averaged(model, source.s,
                   std::span(all).first(size).last(modeCoefficients(model.attributes(), size)), to, scratch);
  if (model.isDisplacementDriven()) {
    PatchStiffness::Value stiffness;
    model.stiffness().at(model.surface(), source.s, stiffness);
    for (std::size_t k = 0; k < moved.size(); ++k) moved[k] += compliance[k] * (stiffness.K * p);
  }
  for (Vec3& part : moved) part *= source.gain;
  return moved;
}

/// Of a source that is asked for this patch alone.
TouchPatch::Averages movedBy(const MetaModel& model, const FieldSource& source, const TouchPatch& to,
                             FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  Compliance compliance;
  if (model.isDisplacementDriven())
    compliance = complianceBetween(model, scratch.touchAt(model, source.s), to, scratch);
  return movedBy(model, source, to, compliance, scratch);
}

/// What one tool moves the others' patches by, and its derivative. The organ is asked once, however many others there are.
class Influence {
 public:
  Influence(const MetaModel& model, const ContactPoint& s, const Vec3& d,
            double h) noexcept PALPATE_NONBLOCKING : model_(model),
                                                     s_(s),
                                                     h_(h),
                                                     own_(ownPart(model, s, d)) {
    if (model.isDisplacementDriven()) differentiate(d);
    for (std::size_t i = 0; !model.isDisplacementDriven() && i < 3; ++i)
      beside_[i] = ownPart(model, s, d + h * Vec3::Unit(static_cast<Eigen::Index>(i)));
  }

  /// P_at u(s, d), m, and P_at du/dd, 3 x 3; of a load-driven model by differences of length h.
  void on(const TouchPatch& at, FieldScratch& scratch, Vec3& moved,
          Mat3& slope) const noexcept PALPATE_NONBLOCKING {
    moved.setZero();
    slope.setZero();
    if (model_.surface().mix(s_).count == 0 || at.nodes().count == 0) return;
    Compliance compliance;
    if (model_.isDisplacementDriven())
      compliance = complianceBetween(model_, scratch.touchAt(model_, s_), at, scratch);
    moved = movedBy(model_, own_, at, compliance, scratch)[0];
    if (!model_.isDisplacementDriven()) {
      for (std::size_t i = 0; i < 3; ++i)
        slope.col(Eigen::Index(i)) = (movedBy(model_, beside_[i], at, scratch)[0] - moved) / h_;
      return;
    }
    slope = compliance[0] * stiffness_.K;
    for (std::size_t i = 0; i < 3; ++i)
      slope.col(Eigen::Index(i)) += averaged(model_, s_, std::span(slope_[i]).first(bends_), at, scratch)[0];
  }

 private:
  void differentiate(const Vec3& d) noexcept PALPATE_NONBLOCKING {
    std::array<Vec3, MonomialBasis::kMaxCoefficients> all;
    const std::span<Vec3> gradient(all.data(), index(model_.functions().size()));
    fieldGradients(model_, d, model_.response().limit(model_.surface().mix(s_)), gradient);
    bends_ = gradient.size() - kLinearCoefficients;
    for (std::size_t k = 0; k < bends_; ++k)
      for (std::size_t i = 0; i < 3; ++i)
        slope_[i][k] = gradient[k + kLinearCoefficients][static_cast<Eigen::Index>(i)];
    model_.stiffness().at(model_.surface(), s_, stiffness_);
  }

  const MetaModel& model_;
  const ContactPoint& s_;
  double h_;
  FieldSource own_;
  std::array<FieldSource, 3> beside_;  // at d + h e_i, of a load-driven model
  PatchStiffness::Value stiffness_;
  std::array<std::array<double, MonomialBasis::kMaxCoefficients>, 3>
      slope_;             // dphi/dd_i of orders two and more
  std::size_t bends_{0};  // how many
};

}  // namespace

Vec3 patchDisplacement(const MetaModel& model, const FieldSource& source, const ContactPoint& at,
                       FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  if (model.surface().mix(at).count == 0) return Vec3::Zero();
  return movedBy(model, source, scratch.touchAt(model, at), scratch)[0];
}

Mat3 patchDisplacementSlope(const MetaModel& model, std::span<const FieldSource> sources,
                            const ContactPoint& at, FieldScratch& scratch) noexcept PALPATE_NONBLOCKING {
  if (model.surface().mix(at).count == 0) return Mat3::Zero();
  const TouchPatch& to = scratch.touchAt(model, at);
  Mat3 by_lambda = Mat3::Zero();
  for (const FieldSource& source : sources) {
    const TouchPatch::Averages moved = movedBy(model, source, to, scratch);
    for (std::size_t k = 0; k < 3; ++k) by_lambda.col(Eigen::Index(k)) += moved[k + 1];
  }
  return by_lambda * model.surface().slopes(at.triangle);
}

FieldSource ownPart(const MetaModel& model, const ContactPoint& s,
                    const Vec3& d) noexcept PALPATE_NONBLOCKING {
  Response response;
  const ResponseStatus status = respond(model, s, d, response);
  FieldSource source{s, response.parameter, 1.0};
  const double answered = response.displacement.norm();
  if (status == ResponseStatus::kBeyond && answered > 0.0 &&
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
      Vec3 u;
      Mat3 change;
      of.on(scratch.touchAt(model, s[a]), scratch, u, change);
      moved[a] += u;
      slope.setPart(a, b, change);
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
  constexpr double kStep = 0.002;  // of r_max: short against it, long against rounding
  const Vec3 y = own - d;
  Response there;
  (void)respond(model, s, d, there);
  const double share = std::min(1.0, kStep * there.series_radius / std::max(y.norm(), 1e-30));
  if (!(share > 0.0)) return {ownPart(model, s, d), FieldSource{s, Vec3::Zero(), 0.0}};
  std::array<FieldSource, 2> part{ownPart(model, s, d), ownPart(model, s, d + share * y)};
  part[0].gain *= 1.0 - 1.0 / share;
  part[1].gain /= share;
  return part;
}

}  // namespace palpate
