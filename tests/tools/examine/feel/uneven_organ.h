// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model/meta_model.h"
#include "palpate/testing/synthetic_model.h"

namespace palpate::testing {

/// Normal stiffness of unevenOrgan() where it is neither soft nor stiff, N/m.
inline constexpr double kUnevenStiffness = 450.0;

/// A small round organ, 0.6 to 1.4 times as stiff from place to place.
inline const MetaModel& unevenOrgan() {
  static const MetaModel model = [] {
    SyntheticOptions options;
    options.contrast = 0.4;
    const TemporaryFile file("uneven.h5");
    writeSyntheticModel(file.path(), options);
    return MetaModel::load(file.path());
  }();
  return model;
}

/// So many of what a sanitizer slows down by a factor of ten.
constexpr int fewerUnderSanitizers(int count) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return count / 6;
#else
  return count;
#endif
}

}  // namespace palpate::testing
