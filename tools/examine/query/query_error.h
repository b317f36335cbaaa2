// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace palpate::query {

/// A question that has no answer, a table that cannot be read, or a file that cannot be written. what() is one line that names it.
class QueryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate::query
