// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::testing {

/// Folder of the programs of this build, absolute.
[[nodiscard]] std::string binDir();

/// Folder of real meshes beside the repository, absolute; it may be absent, and tests that need it skip.
[[nodiscard]] std::string dataDir();

}  // namespace palpate::testing
