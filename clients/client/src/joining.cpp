// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/joining.h"

#include <iostream>
#include <utility>

namespace palpate::client {

dds::Participant join(std::uint32_t domain, const std::filesystem::path& security,
                      std::initializer_list<dds::Role> roles) {
  std::optional<dds::Identity> identity = dds::identityFor(roles, security);
  if (identity && !identity->warning().empty()) std::cerr << "warning: " << identity->warning() << "\n";
  return dds::Participant(domain, std::move(identity));
}

}  // namespace palpate::client
