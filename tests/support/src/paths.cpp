// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/paths.h"

namespace palpate::testing {

std::string binDir() {
  return PALPATE_BIN_DIR;
}

std::string dataDir() {
  return PALPATE_DATA_DIR;
}

}  // namespace palpate::testing
