// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/meta_model.h"
#include "tools/examine/certify/quantile_bound.h"
#include "tools/examine/certify/reference_solver.h"
#include "tools/examine/certify/touch_sampler.h"

namespace palpate::certify {

/// What became of one touch.
enum class Outcome : std::uint8_t {
  kWithin,       ///< in the domain and solved
  kBeyond,       ///< flagged by the model, and solved
  kNotSolved,    ///< no full solution
  kNotExamined,  ///< flagged, and not solved, since enough of those were
};

/// "within", "beyond", "not_converged", "not_examined".
[[nodiscard]] const char* toString(Outcome outcome) noexcept;

/// One touch, model against full solution.
struct Finding {
  Touch touch;
  Outcome outcome{Outcome::kNotExamined};
  bool flagged{false};      ///< abs(d) > d_max(s)
  double force_error{0.0};  ///< forceError()
  double field_error{0.0};  ///< largest |u - u_Newton| over the surface nodes / abs(d)
  double min_det_f{1.0};    ///< of the full solution
};

/// All touches, in the order in which they were drawn.
struct Examination {
  std::vector<Finding> findings;

  [[nodiscard]] std::vector<Finding> of(Outcome outcome) const;
  [[nodiscard]] std::size_t count(Outcome outcome) const;
};

/// How much is examined.
struct Extent {
  std::size_t samples{kSamples};  ///< touches within the domain, >= 1
  int threads{1};
};

/// Draws touches until as many as asked for are in the domain and solved, at most 20 times as many. Those beyond the domain are
/// solved too, up to as many as samples. Prints progress on standard error.
/// @param travel  m, of the force error's floor  @throw CertifyError, query::QueryError, std::runtime_error
[[nodiscard]] Examination examine(const MetaModel& model, const query::Organ& organ, TouchSampler& touches,
                                  double travel, const Extent& extent);

/// abs(d) > d_max(s): the model flags its answer.
[[nodiscard]] bool isBeyond(const MetaModel& model, const Touch& touch);

/// |f - f_Newton| / max(|f_Newton|, 5 % of the model's |f| at the travel, for the same s and direction).
/// @param force  what the model answers, N  @param truth  N  @param travel  m
[[nodiscard]] double forceError(const MetaModel& model, const Touch& touch, const Vec3& force,
                                const Vec3& truth, double travel);

/// Largest |u - u_Newton| of any surface node, over a length. @param field  [Ns][3], what the model answers, m @param length  m
/// @return infinity where the field is not finite
[[nodiscard]] double fieldError(std::span<const float> field, const query::FullSolution& truth,
                                const query::Organ& organ, double length);

/// @throw CertifyError naming the touch, where one of the errors is not finite
void requireFinite(const Touch& touch, double force_error, double field_error);

/// Compares the model's answer with the full solution. @param[in,out] finding  with its touch
/// @throw CertifyError naming the touch, where the answer or its error is not finite
void compare(const MetaModel& model, const query::Organ& organ, const query::FullSolution& truth,
             double travel, Finding& finding);

}  // namespace palpate::certify
