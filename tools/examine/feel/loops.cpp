// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/feel/loops.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/contact_point.h"
#include "tools/examine/feel/player.h"
#include "tools/examine/feel/surface_path.h"

namespace palpate::feel {

namespace {

/// Sums the work of the hand.
class Ledger {
 public:
  Ledger(const MetaModel& model, const StepConfig& config) : model_(model), player_(model, config) {}

  void to(const Vec3& c) {
    constexpr double kLeft = 1e-3;  // N
    const ToolResult& result = player_.at(c);
    const Vec3 force = forceOf(result);
    if (begun_) book_.work -= 0.5 * (force + force_).dot(c - c_);
    if (result.state != 0) {
      const Vec3 d(result.displacement[0], result.displacement[1], result.displacement[2]);
      const Vec3 anchor(result.anchor[0], result.anchor[1], result.anchor[2]);
      const ContactPoint s = model_.surface().closestPoint(anchor).s;
      book_.stored = std::max(book_.stored, PatchResponse(model_, s).energy(d));
      book_.highest = std::max(book_.highest, d.norm());
      touched_ = true;
    } else if (touched_) {
      if (force_.norm() > kLeft) ++book_.releases;
      touched_ = false;
    }
    c_ = c;
    force_ = force;
    begun_ = true;
  }
  [[nodiscard]] const LoopResult& book() const noexcept { return book_; }

 private:
  const MetaModel& model_;
  Player player_;
  LoopResult book_;
  Vec3 c_ = Vec3::Zero(), force_ = Vec3::Zero();
  bool begun_{false}, touched_{false};
};

/// A closed path of d that begins and ends at zero and never pulls: sines of the time along the normal and
/// across it.
class HeldWay {
 public:
  HeldWay(double reach, const Vec3& n, std::mt19937& random) : n_(n) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    across_ = Vec3(uniform(random), uniform(random), uniform(random)).cross(n).normalized();
    other_ = n.cross(across_);
    reach_ = reach * (0.6 + 0.3 * uniform(random));
    for (double& a : amplitude_) a = 0.2 * uniform(random);
  }
  /// @param[in] x  0 to 1
  [[nodiscard]] Vec3 at(double x) const {
    using std::numbers::pi;
    const double press = std::pow(std::sin(pi * x), 2);
    const double a = amplitude_[0] * std::sin(2.0 * pi * x) + amplitude_[1] * std::sin(4.0 * pi * x);
    const double b = amplitude_[2] * std::sin(2.0 * pi * x) + amplitude_[3] * (1.0 - std::cos(6.0 * pi * x));
    return reach_ * press * (-0.8 * n_ + a * across_ + b * other_);
  }

 private:
  Vec3 n_, across_, other_;
  double reach_;
  std::array<double, 4> amplitude_{};
};

}  // namespace

std::vector<LoopResult> heldLoops(const MetaModel& model, const LoopOptions& options) {
  constexpr double kSeconds = 1.0;
  std::mt19937 random(options.seed);
  std::vector<LoopResult> results;
  const StepConfig config = bareContact(std::numeric_limits<double>::infinity());
  while (static_cast<int>(results.size()) < options.loops) {
    const ContactPoint s = randomContact(model, random);
    const Vec3 n = model.surface().normal(s);
    const Vec3 start = model.surface().position(s) + (config.tip_radius + 1e-9) * n;
    const HeldWay way(0.9 * model.response().limit(model.surface().mix(s)), n, random);
    Ledger ledger(model, config);
    ledger.to(start);
    for (double t = 0.0; t < kSeconds; t += options.tick) ledger.to(start + way.at(t / kSeconds));
    ledger.to(start);
    results.push_back(ledger.book());
  }
  return results;
}

std::vector<LoopResult> slidingLoops(const MetaModel& model, const LoopOptions& options, double depth,
                                     double friction) {
  constexpr double kSpeed = 0.05;                      // m/s
  constexpr double kNearest = 0.02, kFarthest = 0.04;  // m
  constexpr double kContrast = 1.2;                    // of the normal stiffness at the two ends
  std::mt19937 random(options.seed);
  std::vector<LoopResult> results;
  const StepConfig config = bareContact(friction);
  const double step = kSpeed * options.tick;
  while (static_cast<int>(results.size()) < options.loops) {
    ContactPoint a = randomContact(model, random), b = randomContact(model, random);
    const double apart = (model.surface().position(a) - model.surface().position(b)).norm();
    const double contrast = normalStiffness(model, a) / normalStiffness(model, b);
    if (apart < kNearest || apart > kFarthest || std::max(contrast, 1.0 / contrast) < kContrast) continue;
    if ((contrast > 1.0) == (results.size() % 2 == 0)) std::swap(a, b);  // soft to stiff, stiff to soft
    const auto path = pathBetween(model, a, b, step);
    if (!path) continue;
    Ledger ledger(model, config);
    const auto to = [&](const PathPoint& p, double d) {
      ledger.to(p.position + (config.tip_radius - d) * p.normal);
    };
    // The path begins and ends in the air: the contact surface is rounded and extends beyond the mesh, and a
    // loop that began inside it would return energy that no work put in.
    const double clear = 1e-3 + model.contactSurface().bulge();
    for (double d = -clear; d < depth; d += step) to(path->front(), d);
    for (const PathPoint& point : *path) to(point, depth);
    for (double d = depth; d > -clear; d -= step) to(path->back(), d);
    results.push_back(ledger.book());
  }
  return results;
}

}  // namespace palpate::feel
