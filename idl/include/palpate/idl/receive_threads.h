// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace palpate::dds {

/// Names of the threads in which Cyclone DDS 0.10 receives and calls listeners. It refuses priorities for them in its
/// configuration, so a process raises them by name once its participant exists.
inline constexpr std::string_view kReceiveThreads[] = {"recv", "recvUC", "recvMC"};

}  // namespace palpate::dds
