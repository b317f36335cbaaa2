// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palpate/idl/entity.h"

namespace palpate::dds {

/// One line when a counterpart of a writer or reader is there that does not match: by which policies, and whose it is;
/// empty when none is. Looks at all that DDS discovered, so not for a loop: EndpointWatch is. Real-time: no.
[[nodiscard]] std::string mismatchOf(dds_entity_t endpoint, bool writes);

}  // namespace palpate::dds
