// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palpate/testing/test_domain.h"

namespace palpate::testing {

/// A client's arguments, on a DDS domain that no other test uses.
inline std::vector<std::string> onDomain(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--domain", std::to_string(exclusiveDomain())});
  return arguments;
}

}  // namespace palpate::testing
