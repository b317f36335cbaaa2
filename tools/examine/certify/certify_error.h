// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace palpate::certify {

/// A model or an option that cannot be certified with. what() is one line that names it.
class CertifyError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate::certify
