// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <filesystem>
#include <string>

namespace palpate::dds {

/// Who besides its owner may do what with a file or a folder.
enum class Others {
  kRead,    ///< not write: who can takes the authority's place
  kNothing  ///< not even read: keys
};

/// A file of an identity or an authority belongs to this user or root, and others may do no more than that.
/// @throw DdsError naming it, what is wrong and what to do
void checkFile(const std::filesystem::path& file, Others others);
void checkFolder(const std::filesystem::path& folder, Others others);

/// @param[in] file  named in what is thrown
/// @param[in] remedy  what to do when it has ended, "palpate-security ... makes a new one"
/// @throw DdsError  now is before `start`, or not before `end`
void checkTimes(const std::filesystem::path& file, std::time_t start, std::time_t end,
                const std::string& remedy);

/// What to do when an authority has ended.
inline constexpr const char* kAnotherAuthority =
    "palpate-security init --folder ANOTHER makes another authority, which is to issue all identities again";

}  // namespace palpate::dds
