// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace palpate {

/// A model file that cannot be used. what() is one sentence: file, dataset, what was found, what was
/// expected.
class LoadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate
