// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace palpate::solver {

/// A case file or an option is invalid. what() names the file, the line and the key.
class CaseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate::solver
