// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace palpate::viewer {

/// Logs a line that strangers can cause: one per second, the others are dropped, so that they do not fill the disk.
/// Threads: the one that serves.
void warnRarely(std::string_view text);

}  // namespace palpate::viewer
