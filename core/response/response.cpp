// SPDX-License-Identifier: Apache-2.0
#include "core/response/response.h"

namespace palpate {

std::string_view toString(ResponseStatus status) noexcept {
  switch (status) {
    case ResponseStatus::kOk:
      return "ok";
    case ResponseStatus::kBeyond:
      return "beyond_domain";
    case ResponseStatus::kNoAnswer:
      return "not_accessible";
  }
  return "unknown";
}

}  // namespace palpate
