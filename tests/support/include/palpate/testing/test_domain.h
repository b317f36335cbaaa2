// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace palpate::testing {

/// Keeps Cyclone on loopback without multicast, unless the environment already says otherwise: works in a
/// sandbox without a network and keeps tests of two machines apart. Child processes inherit it.
void useLoopback();

/// A domain id between 1 and 100 that this process holds until it ends, by a lock on a file: two tests that run at
/// once never see each other's samples, nor those of a server that somebody runs. The ports of a domain above 100 are
/// those that Linux gives out by itself.
[[nodiscard]] std::uint32_t exclusiveDomain();

}  // namespace palpate::testing
