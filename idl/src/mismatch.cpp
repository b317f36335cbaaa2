// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/mismatch.h"

#include <chrono>
#include <vector>

#include "palpate/idl/endpoint_watch.h"

namespace palpate::dds {

std::string mismatchOf(dds_entity_t endpoint, bool writes) {
  EndpointWatch watch(dds_get_participant(endpoint), std::chrono::milliseconds(0));
  watch.add(endpoint, writes);
  const std::vector<std::string> lines = watch.poll();
  return lines.empty() ? std::string() : lines.front();
}

}  // namespace palpate::dds
