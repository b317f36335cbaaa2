// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace palpate::offline {

/// A case file, or an option, that cannot be taken. what() names file, line and key.
class CaseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What to solve: the contents of a case file, or the defaults for a bare mesh. SI units.
struct Case {
  std::filesystem::path mesh;  ///< volume mesh in metres; relative paths start at the case file
  std::string fixed{"fixed"};  ///< physical group of the clamped nodes
  std::optional<std::string>
      accessible;           ///< physical group that a tool may touch; absent: all but the fixed nodes
  std::string law{"stvk"};  ///< "stvk"
  double E{160e3};          ///< Pa, (0, 1e12]
  double nu{0.48};          ///< [-0.99, 0.4999]
  std::optional<double> patch_radius;  ///< a, m, (0, 1]; absent: 1.3 median surface edges
  int order{3};                        ///< p, 1 to 7
  int modes{120};                      ///< n, 1 to 2000
  double near_radius{0.025};           ///< rho, m, [0, 1]
  int sweeps{6};                       ///< of the far-field fit, 1 to 1000
  std::string text;                    ///< the case file as read, for the provenance
};

/// Reads a case file (TOML). Every key is known, of its type and in range, or it is refused by name and line.
/// @throw CaseError
[[nodiscard]] Case readCase(const std::filesystem::path& path);

/// The defaults for a mesh without a case file. If it has a group `accessible`, that is used; see solve.
[[nodiscard]] Case defaultCase(const std::filesystem::path& mesh);

}  // namespace palpate::offline
