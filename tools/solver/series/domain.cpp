// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/series/domain.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "tools/solver/base/lanes.h"
#include "tools/solver/fem/fe_model.h"

namespace palpate::solver {

namespace {

/// Where the terms of a degree vanish by chance the ratio of two degrees has no meaning; with at most this ratio a
/// tail is at most four times the last term.
constexpr double kSlowest = 0.8;

/// Estimates the truncation error of a series from its last terms: the terms beyond are taken to fall as
/// slowly as over the last degree or the last two. Near the radius of convergence this tail exceeds the last
/// terms. docs/design.md, Series
double remainder(double last, double previous, double before_previous) {
  if (last == 0.0) return 0.0;
  const double ratio = std::min(kSlowest, std::max(last / previous, std::sqrt(last / before_previous)));
  return last * std::max(1.0, ratio / (1.0 - ratio));
}

/// The answer and its derivative along one ray, x = r e, by degree. The monomials are summed once, so each r
/// costs one term per degree.
class Ray {
 public:
  Ray(const MonomialBasis& basis, std::span<const Vec3> coefficients, int kept, double tolerance,
      const Vec3& direction);
  [[nodiscard]] bool isTrusted(double r) const;

 private:
  std::size_t order_;
  std::size_t kept_;                                       // highest degree in the model
  double tolerance_;                                       // of the truncation error
  std::array<Vec3, MonomialBasis::kMaxOrder + 1> terms_;   // of degree n at r = 1
  std::array<Mat3, MonomialBasis::kMaxOrder + 1> slopes_;  // of those, symmetric part; kept degrees only
};

Ray::Ray(const MonomialBasis& basis, std::span<const Vec3> coefficients, int kept, double tolerance,
         const Vec3& direction)
    : order_(static_cast<std::size_t>(basis.order())),
      kept_(static_cast<std::size_t>(kept)),
      tolerance_(tolerance) {
  std::array<double, MonomialBasis::kMaxCoefficients> value{};
  std::array<Vec3, MonomialBasis::kMaxCoefficients> slope;
  basis.evaluate(direction, value);
  basis.gradient(direction, slope);
  terms_.fill(Vec3::Zero());
  slopes_.fill(Mat3::Zero());
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    const MultiIndex& a = basis[static_cast<int>(k)];
    const auto degree = static_cast<std::size_t>(a[0] + a[1] + a[2]);
    terms_[degree] += value[k] * coefficients[k];
    if (degree <= kept_) slopes_[degree] += coefficients[k] * slope[k].transpose();
  }
  for (Mat3& K : slopes_) K = (0.5 * (K + K.transpose())).eval();
}

bool Ray::isTrusted(double r) const {
  std::array<double, MonomialBasis::kMaxOrder + 1> size{};  // of the terms of each degree
  Vec3 whole = Vec3::Zero(), cut = Vec3::Zero();
  Mat3 K = Mat3::Zero();
  double power = 1.0;  // r^(n-1)
  for (std::size_t n = 1; n <= order_; ++n, power *= r) {
    const Vec3 term = power * r * terms_[n];
    size[n] = term.norm();
    whole += term;
    if (n > kept_) cut += term;
    K += power * slopes_[n];
  }
  if (order_ > 1) {  // a linear answer has no term to estimate its error from
    const double before_previous = order_ > 2 ? size[order_ - 2] : std::numeric_limits<double>::infinity();
    const double tail = remainder(size[order_], size[order_ - 1], before_previous);
    if (cut.norm() + tail > tolerance_ * whole.norm()) return false;
  }
  return K.llt().info() == Eigen::Success;
}

using Sizes = std::array<double, MonomialBasis::kMaxOrder + 1>;

/// Size of the terms of each degree at x = direction, the largest over the nodes.
/// @param coefficients  [node][k]
Sizes termSizes(const MonomialBasis& basis, std::span<const Vec3> coefficients, const Vec3& direction) {
  std::array<double, MonomialBasis::kMaxCoefficients> value{};
  basis.evaluate(direction, value);
  Sizes largest{};
  const auto count = static_cast<std::size_t>(basis.size());
  for (std::size_t begin = 0; begin < coefficients.size(); begin += count)
    for (int degree = 1; degree <= basis.order(); ++degree) {
      Vec3 term = Vec3::Zero();
      for (auto k = static_cast<std::size_t>(basis.begin(degree));
           k < static_cast<std::size_t>(basis.begin(degree + 1)); ++k)
        term += value[k] * coefficients[begin + k];
      double& size = largest[static_cast<std::size_t>(degree)];
      size = std::max(size, term.norm());
    }
  return largest;
}

/// By how much terms grow from degree to degree at abs(d) = 1: as over the last degree of the fields or the last two,
/// or in the mean as those of the force, which is known further: from degree p on, over two degrees at least.
double growth(const Sizes& fields, int p, const Sizes& force, int force_order) {
  const auto size = [](const Sizes& sizes, int n) { return sizes[static_cast<std::size_t>(n)]; };
  double ratio = p > 1 ? size(fields, p) / size(fields, p - 1) : 0.0;
  if (p > 2) ratio = std::max(ratio, std::sqrt(size(fields, p) / size(fields, p - 2)));
  const int from = std::max(1, std::min(p, force_order - 2));
  return std::max(ratio, std::pow(size(force, force_order) / size(force, from), 1.0 / (force_order - from)));
}

/// x^alpha for x = radius * direction, per lane. @param[out] monomials  one per coefficient
void laneMonomials(const MonomialBasis& basis, const Vec3& direction, const Lanes& radius,
                   LaneVector& monomials) {
  std::array<double, MonomialBasis::kMaxCoefficients> unit{};
  basis.evaluate(direction, unit);
  Lanes power = radius;
  for (int degree = 1; degree <= basis.order(); ++degree, power *= radius)
    for (int k = basis.begin(degree); k < basis.begin(degree + 1); ++k)
      monomials[static_cast<std::size_t>(k)] = power * unit[static_cast<std::size_t>(k)];
}

/// The points in which some lane could pass below the limit, det F >= (1 - |H|)^3, with their nodes and the fields there.
class Suspects {
 public:
  Suspects(const MonomialBasis& basis, const KernelInput& input, double min_det_f, const Lanes& radius);
  [[nodiscard]] bool empty() const { return U_.empty(); }
  /// Smallest det F of each lane, at most 1. @param monomials  x^alpha of each lane's sample
  [[nodiscard]] Lanes leastDet(const LaneVector& monomials);

 private:
  std::int32_t placeOf(const KernelInput& input, std::int32_t node);

  std::vector<std::int32_t> place_;  // of a node in the fields here, or -1
  FeModel::Points points_;
  LaneVector U_, summed_;
  KernelInput fields_;
};

Suspects::Suspects(const MonomialBasis& basis, const KernelInput& input, double min_det_f,
                   const Lanes& radius) {
  const auto count = std::visit([](const auto& points) { return points.size(); }, *input.points);
  FloatLaneVector powers, bounds(count);
  Lanes power = radius / input.length;
  for (int degree = 1; degree <= basis.order(); ++degree, power *= radius / input.length)
    powers.push_back(__builtin_convertvector(power, FloatLanes));
  gradientBounds(input, powers.data(), bounds.data());
  const double rounding = 1e-5;
  const double harmless = 1.0 - std::cbrt(min_det_f) - rounding;
  const auto isSuspect = [&](std::size_t n) {
    bool suspect = false;
    for (int lane = 0; lane < kLanes; ++lane)
      suspect = suspect || !(static_cast<double>(bounds[n][lane]) < harmless);
    return suspect;
  };
  std::visit(
      [&](const auto& points) {
        std::decay_t<decltype(points)> taken;
        for (std::size_t n = 0; n < points.size(); ++n)
          if (isSuspect(n)) taken.push_back(points[n]);
        for (auto& point : taken)
          for (std::int32_t& node : point.nodes) node = placeOf(input, node);
        points_ = std::move(taken);
      },
      *input.points);
  summed_.resize(U_.size() / static_cast<std::size_t>(input.coefficients));
  fields_ = {&points_, input.coefficients, U_.data(), {}, {}};
}

/// Takes over the fields of a node when it is met first.
std::int32_t Suspects::placeOf(const KernelInput& input, std::int32_t node) {
  const auto old = static_cast<std::size_t>(node);
  const std::size_t count = static_cast<std::size_t>(input.coefficients) * 3;
  if (place_.size() <= old) place_.resize(old + 1, -1);
  if (place_[old] < 0) {
    place_[old] = static_cast<std::int32_t>(U_.size() / count);
    U_.insert(U_.end(), input.U + old * count, input.U + (old + 1) * count);
  }
  return place_[old];
}

Lanes Suspects::leastDet(const LaneVector& monomials) {
  sumFields(fields_, static_cast<int>(summed_.size() / 3), monomials.data(), summed_.data());
  KernelInput summed = fields_;
  summed.U = summed_.data();
  summed.coefficients = 1;
  Lanes least = Lanes{} + 1.0;
  leastDetF(summed, &least);
  return least;
}

}  // namespace

const std::vector<Vec3>& sampledDirections() {
  static const std::vector<Vec3> directions = [] {
    std::vector<Vec3> list;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (x != 0 || y != 0 || z != 0) list.push_back(Vec3(x, y, z).normalized());
    return list;
  }();
  return directions;
}

double answerRadius(const MonomialBasis& basis, std::span<const Vec3> answer, int kept, double cap,
                    double tolerance) {
  constexpr int kScan = 100;  // scan for the radius, then halve between two samples
  double radius = cap;
  for (const Vec3& direction : sampledDirections()) {
    const Ray ray(basis, answer, kept, tolerance, direction);
    double good = 0.0;
    const double step = cap / kScan;
    while (good < radius && ray.isTrusted(std::min(good + step, radius)))
      good = std::min(good + step, radius);
    double bad = std::min(good + step, radius);
    for (int halving = 0; halving < 12 && good < radius; ++halving) {
      const double middle = 0.5 * (good + bad);
      (ray.isTrusted(middle) ? good : bad) = middle;
      if (bad - good < 1e-3 * step) break;
    }
    radius = std::min(radius, good);
  }
  return radius;
}

double fieldRadius(const MonomialBasis& basis, std::span<const Vec3> fields,
                   const MonomialBasis& answer_basis, std::span<const Vec3> answer, double cap,
                   double tolerance) {
  constexpr int kHalvings = 12;
  const int p = basis.order();
  double radius = cap;
  for (const Vec3& direction : sampledDirections()) {
    const Sizes sizes = termSizes(basis, fields, direction);
    const Sizes force = termSizes(answer_basis, answer, direction);
    const double ratio = growth(sizes, p, force, answer_basis.order());
    const double last = sizes[static_cast<std::size_t>(p)];
    const auto isTrusted = [&](double r) {
      const double next = std::min(kSlowest, ratio * r);
      return last * std::pow(r, p - 1) * next <= tolerance * (1.0 - next);
    };
    if (isTrusted(radius)) continue;
    double good = 0.0, bad = radius;
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double middle = 0.5 * (good + bad);
      (isTrusted(middle) ? good : bad) = middle;
    }
    radius = good;
  }
  return radius;
}

void limitByDetF(const MonomialBasis& basis, const KernelInput& input, double min_det_f,
                 std::span<double> radii) {
  Lanes radius{};
  for (std::size_t lane = 0; lane < radii.size(); ++lane) radius[static_cast<int>(lane)] = radii[lane];
  Suspects suspects(basis, input, min_det_f, radius);
  if (suspects.empty()) return;
  LaneVector monomials(static_cast<std::size_t>(basis.size()));
  for (const Vec3& direction : sampledDirections()) {
    // A radius that is too large is halved up to ten times, to a thousandth.
    Lanes good{};
    Lanes tried = radius;
    Lanes step = 0.5 * radius;
    for (int halving = 0; halving < 11; ++halving) {
      laneMonomials(basis, direction, tried, monomials);
      const Lanes det = suspects.leastDet(monomials);
      bool all_good = true;
      for (int lane = 0; lane < kLanes; ++lane) {
        const bool fine = det[lane] >= min_det_f;
        if (fine) good[lane] = std::max(good[lane], tried[lane]);
        if (good[lane] == radius[lane]) continue;
        all_good = false;
        tried[lane] += fine ? step[lane] : -step[lane];
        step[lane] *= 0.5;
      }
      if (all_good) break;
    }
    radius = good;
  }
  for (std::size_t lane = 0; lane < radii.size(); ++lane) radii[lane] = radius[static_cast<int>(lane)];
}

}  // namespace palpate::solver
