// SPDX-License-Identifier: Apache-2.0
#include "core/response/tool_coupling.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "core/base/index.h"
#include "core/base/length.h"
#include "core/model/clamp_to_length.h"
#include "core/response/small_square.h"
#include "core/surface/surface_mesh.h"

namespace palpate {

namespace {

/// Of u at d, and of du/dd there; of a load-driven model by differences of length `step`.
void findFunctions(const MetaModel& model, const ContactPoint& s, const Vec3& d, double step,
                   TouchFunctions& out) noexcept PALPATE_NONBLOCKING {
  const auto size = index(model.functions().size());
  const double limit = model.response().limit(model.surface().mix(s));
  const auto evaluate = [&](const Vec3& at, std::span<double> values) noexcept PALPATE_NONBLOCKING {
    const FieldSource own = ownPart(model, s, at);
    (void)fieldFunctions(model, own.parameter, limit, values);
    for (double& value : values) value *= own.gain;
  };
  evaluate(d, std::span(out[0]).first(size));
  if (model.isDisplacementDriven()) {
    std::array<Vec3, MonomialBasis::kMaxCoefficients> gradient;
    fieldGradients(model, d, limit, std::span(gradient).first(size));
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t i = 0; i < 3; ++i) out[i + 1][k] = gradient[k][Eigen::Index(i)];
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    evaluate(d + step * Vec3::Unit(Eigen::Index(i)), std::span(out[i + 1]).first(size));
    for (std::size_t k = 0; k < size; ++k) out[i + 1][k] = (out[i + 1][k] - out[0][k]) / step;
  }
}

}  // namespace

double tangentStep(std::span<const Vec3> d) noexcept PALPATE_NONBLOCKING {
  constexpr double kShare = 0.01, kLeast = 1e-9;  // of the longest d; m
  double length = 0.0;
  for (const Vec3& prescribed : d) length = std::max(length, prescribed.norm());
  return std::max(kShare * length, kLeast);
}

void touchWith(const MetaModel& model, const ContactPoint& s, const Vec3& d, double step,
               Touch& touch) noexcept PALPATE_NONBLOCKING {
  touch.patch.moveTo(model, s);
  const double used = model.isDisplacementDriven() ? 0.0 : step;
  if (touch.field.is(s, d, used)) return;
  TouchFunctions functions;
  findFunctions(model, s, d, step, functions);
  touch.field.set(model, touch.patch, d, used, functions);
}

FieldSource ownPart(const MetaModel& model, const ContactPoint& s,
                    const Vec3& d) noexcept PALPATE_NONBLOCKING {
  if (model.isDisplacementDriven()) {
    const Vec3 shown = clampToLength(d, kShownRadii * model.response().limit(model.surface().mix(s)));
    const double length = lengthOf(shown);
    return {s, shown, length > 0.0 ? lengthOf(d) / length : 1.0};
  }
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
                      Touches& touches, std::span<Vec3> own,
                      Influence* influence) noexcept PALPATE_NONBLOCKING {
  const std::size_t tools = std::min<std::size_t>(s.size(), kMaxTools);
  std::copy(d.begin(), d.end(), own.begin());
  if (influence != nullptr) {
    for (auto& row : influence->by_d) row.fill(Mat3::Zero());
    influence->along.fill(Mat3::Zero());
  }
  const auto moves = [](const Vec3& prescribed) { return prescribed != Vec3::Zero(); };
  if (tools < 2 || std::none_of(d.begin(), d.end(), moves)) return;
  const double step = tangentStep(d);
  std::array<std::array<PatchMotion, kMaxTools>, kMaxTools> motion;
  SmallSquare slope(tools);
  std::array<Vec3, kMaxTools> moved;
  moved.fill(Vec3::Zero());
  for (std::size_t a = 0; a < tools; ++a) touchWith(model, s[a], d[a], step, touches.all[a]);
  for (std::size_t b = 0; b < tools; ++b)
    for (std::size_t a = 0; a < tools; ++a) {
      if (a == b) continue;
      motion[a][b] = patchMotion(model, touches.all[b], touches.all[a]);
      moved[a] += motion[a][b].at(Vec3::Zero());
      slope.setPart(a, b, motion[a][b].slope());
    }
  const SmallSquare inverse = dampedInverse(slope);
  for (std::size_t a = 0; a < tools; ++a)
    for (std::size_t b = 0; b < tools; ++b) own[a] -= inverse.part(a, b) * moved[b];
  if (influence == nullptr) return;
  slope.subtractUnit();
  const SmallSquare carried = product(inverse, slope);  // e = inverse moved
  for (std::size_t a = 0; a < tools; ++a) {
    Mat3 by_lambda = Mat3::Zero();
    for (std::size_t b = 0; b < tools; ++b) {
      influence->by_d[a][b] = carried.part(a, b);
      if (a != b) by_lambda += motion[a][b].along(own[b] - d[b]);
    }
    influence->along[a] = by_lambda * model.surface().slopes(s[a].triangle);
  }
}

namespace {

/// How long d is at which polynomials end, m.
double seriesRadius(const MetaModel& model, const ContactPoint& s,
                    const Vec3& d) noexcept PALPATE_NONBLOCKING {
  if (model.isDisplacementDriven()) return model.response().limit(model.surface().mix(s));
  Response there;
  (void)respond(model, s, d, there);
  return there.series_radius;
}

}  // namespace

std::array<FieldSource, 2> ownField(const MetaModel& model, const ContactPoint& s, const Vec3& d,
                                    const Vec3& own) noexcept PALPATE_NONBLOCKING {
  constexpr double kStep = 0.002;  // of r_max: short against it, long against rounding
  const Vec3 y = own - d;
  const double share = std::min(1.0, kStep * seriesRadius(model, s, d) / std::max(y.norm(), 1e-30));
  if (!(share > 0.0)) return {ownPart(model, s, d), FieldSource{s, Vec3::Zero(), 0.0}};
  std::array<FieldSource, 2> part{ownPart(model, s, d), ownPart(model, s, d + share * y)};
  part[0].gain *= 1.0 - 1.0 / share;
  part[1].gain /= share;
  return part;
}

void addOthersAt(const MetaModel& model, std::span<const ToolPart> tools, Touches& touches,
                 std::span<const ContactPoint> points, std::span<Vec3> u) noexcept PALPATE_NONBLOCKING {
  for (std::size_t b = 0; b < tools.size(); ++b) {
    const ToolPart& tool = tools[b];
    Touch& touch = touches.all[b];
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].triangle < 0 || points[i] == tool.s) continue;
      touchWith(model, tool.s, tool.d, 0.0, touch);  // nothing to do for the other points
      u[i] +=
          tool.gain * touch.field.at(model, touch.patch, tool.own - tool.d, points[i], touches.amplitudes);
    }
  }
}

}  // namespace palpate
