// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace palpate::fit {

/// A curve, a place or an option that gives no modulus. what() is one line that names it.
class FitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate::fit
