// SPDX-License-Identifier: Apache-2.0
#include "core/data/parameter_functions.h"

#include <algorithm>
#include <array>

namespace palpate {

namespace {

double referenceOf(const ModelAttributes& attributes) noexcept PALPATE_NONBLOCKING {
  switch (attributes.parameters) {
    case Parameters::kDisplacement:
      return attributes.reference_displacement;
    case Parameters::kForce:
      return attributes.reference_force;
    case Parameters::kLevel:
      return 1.0;
  }
  return 1.0;
}

}  // namespace

ParameterFunctions::ParameterFunctions(const ModelView& view, const ModelAttributes& attributes, int order)
    : basis_(attributes.parameters == Parameters::kLevel ? 1 : order),
      reference_(referenceOf(attributes)),
      size_(basis_.size()) {
  if (attributes.parameters != Parameters::kLevel) return;
  Z_ = view.levels_Z;
  size_ = static_cast<int>(view.level_functions);
  level_steps_ = static_cast<int>(Z_.size() / view.level_functions) - 1;
}

ParameterFunctions::Place ParameterFunctions::place(double t) const noexcept PALPATE_NONBLOCKING {
  const double at = (t > 0.0 ? std::min(t, 1.0) : 0.0) * level_steps_;  // NaN is at rest
  const int step = std::min(static_cast<int>(at), level_steps_ - 1);
  return {static_cast<std::size_t>(step), at - step};
}

const double* ParameterFunctions::row(int q) const noexcept PALPATE_NONBLOCKING {
  return Z_.data() + static_cast<std::size_t>(q) * (static_cast<std::size_t>(level_steps_) + 1);
}

void ParameterFunctions::evaluate(const Vec3& p,
                                  std::span<double> values) const noexcept PALPATE_NONBLOCKING {
  if (level_steps_ == 0) return basis_.evaluate(p / reference_, values);
  const auto [step, weight] = place(p.x());
  for (int q = 0; q < size_; ++q) {
    const double* const z = row(q) + step;
    values[static_cast<std::size_t>(q)] = (1.0 - weight) * z[0] + weight * z[1];
  }
}

void ParameterFunctions::energyShares(const Vec3& p,
                                      std::span<double> shares) const noexcept PALPATE_NONBLOCKING {
  basis_.evaluate(p / reference_, shares);
  for (int degree = 1; degree <= basis_.order(); ++degree) {
    const double part = 1.0 / (degree + 1.0);
    for (int k = basis_.begin(degree); k < basis_.begin(degree + 1); ++k)
      shares[static_cast<std::size_t>(k)] *= part;
  }
}

void ParameterFunctions::gradient(const Vec3& p,
                                  std::span<Vec3> gradient) const noexcept PALPATE_NONBLOCKING {
  std::array<Vec4, MonomialBasis::kMaxCoefficients> all;
  jets(p, all);
  for (std::size_t k = 0; k < static_cast<std::size_t>(size_); ++k) gradient[k] = all[k].tail<3>();
}

void ParameterFunctions::jets(const Vec3& p, std::span<Vec4> jets) const noexcept PALPATE_NONBLOCKING {
  if (level_steps_ == 0) return basis_.jets(p / reference_, jets);
  const auto [step, weight] = place(p.x());
  for (int q = 0; q < size_; ++q) {
    const double* const z = row(q) + step;
    const double value = (1.0 - weight) * z[0] + weight * z[1];
    jets[static_cast<std::size_t>(q)] = Vec4(value, (z[1] - z[0]) * level_steps_, 0.0, 0.0);
  }
}

void ParameterFunctions::bends(const Vec3& p, std::span<const Vec4> jets,
                               std::span<Vec6> bends) const noexcept PALPATE_NONBLOCKING {
  basis_.bends(p / reference_, jets, bends);
}

int lastStep(double limit, int steps) noexcept PALPATE_NONBLOCKING {
  constexpr double kRounding = 1e-9;  // of a step: a limit that is a level but for the last bits begins none
  return std::max(1, static_cast<int>(std::ceil(limit * steps - kRounding)));
}

}  // namespace palpate
