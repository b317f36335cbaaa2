// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace palpate {

/// How much more memory this process may have, and what says so.
struct AvailableMemory {
  std::uint64_t bytes;
  std::string limit;  ///< "the machine", "its control group", "ulimit -v", "ulimit -f"
};

/// The least of: what the kernel calls available, what is left to each control group (version 1 and 2) that the
/// process is in, file pages that can be dropped included, and to its limit of address space.
/// What cannot be read does not limit. @param root  of /proc and /sys, for tests
[[nodiscard]] AvailableMemory availableMemory(const std::filesystem::path& root = "/");

/// Addresses that this process has now, bytes.
[[nodiscard]] std::uint64_t addressSpace();

/// @param what  "its copy", as in "PATH: its copy needs 200 MiB of memory, 100 MiB are available (its control group)"
/// @throw LoadError  fewer bytes are available
void requireMemory(const std::filesystem::path& path, const std::string& what, std::uint64_t bytes);

/// The same for what becomes a file in memory: the process's limit of file size holds for it too.
void requireMemoryFile(const std::filesystem::path& path, const std::string& what, std::uint64_t bytes);

}  // namespace palpate
