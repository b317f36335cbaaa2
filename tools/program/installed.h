// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::program {

/// Where a file lies that is installed with the running program, for --help: its path, if it is there; else, in a build or on a
/// man page made from one, "PREFIX/etc/palpate/server.toml where palpate is installed".
/// @param[in] from_bin  path from the folder of programs, "../etc/palpate/server.toml", or an absolute one
[[nodiscard]] std::string installedText(const std::string& from_bin);

}  // namespace palpate::program
