// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "tools/examine/bench/samples.h"
#include "tools/examine/bench/synthetic_model.h"
#include "tools/modelfile/model_data.h"

namespace palpate::bench {

/// The runners: the field as the server evaluates it, the product of the modes alone by Eigen in float32, and
/// a plain read of the bytes of the modes of the server's model.
enum class Runner { kPalpate, kEigen, kPlainRead };
inline constexpr std::array<Runner, 3> kRunners{Runner::kPalpate, Runner::kEigen, Runner::kPlainRead};

/// One size of field evaluation: the three runners in turn on one synthetic model. Each evaluation has
/// another contact and other amplitudes, in the order of a slide.
class FieldRace {
 public:
  /// @throw modelfile::ModelFileError, LoadError
  explicit FieldRace(const SyntheticSize& size);

  /// Runs the three in alternating blocks, so that other work on the machine disturbs all alike. The first
  /// two evaluations of a block warm the caches and do not count. @param[in] seconds  for all of it, at least
  /// six rounds
  void measure(double seconds);
  [[nodiscard]] const Samples& samples(Runner who) const { return samples_[static_cast<std::size_t>(who)]; }

  /// One evaluation; the next call takes the next contact.
  void run(Runner who);
  /// Bytes of modes that one evaluation reads.
  [[nodiscard]] std::size_t bytes(Runner who) const;
  /// Largest |u - u of the float32 data in double precision| at any node over the largest |u| of that field,
  /// the worst of a few fields. Zero for a read. Valid after measure().
  [[nodiscard]] double errorMax(Runner who) const { return errors_[static_cast<std::size_t>(who)]; }

 private:
  struct Question {
    FieldSource source;
    std::vector<float> amplitudes;  ///< [n] y from the float32 data, m
  };
  void ask();
  [[nodiscard]] double worstError(Runner who);

  modelfile::ModelData data_;  ///< modes_X is float32
  MetaModel model_;
  FieldScratch scratch_;
  std::vector<Question> questions_;
  std::vector<float> u_;
  std::size_t next_{0};
  std::array<Samples, kRunners.size()> samples_;
  std::array<double, kRunners.size()> errors_{};
};

}  // namespace palpate::bench
