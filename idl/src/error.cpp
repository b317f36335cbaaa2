// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/error.h"

#include <dds/dds.h>

namespace palpate::dds {

DdsError::DdsError(const std::string& what_failed, std::int32_t retcode)
    : std::runtime_error(what_failed + ": " + dds_strretcode(retcode)) {}

std::int32_t checked(std::int32_t result, const std::string& what_failed) {
  if (result < 0) throw DdsError(what_failed, result);
  return result;
}

}  // namespace palpate::dds
