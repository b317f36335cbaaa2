// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "targets.h"

namespace palpate::fuzz {

void require(bool good, const char* what) {
  if (!good) throw std::logic_error(what);
}

}  // namespace palpate::fuzz
