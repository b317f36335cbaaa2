// SPDX-License-Identifier: Apache-2.0
// Reads files as a target does, compiled so that the lines are counted: coverage TARGET FOLDER...
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include "targets.h"

int main(int count, char** words) {
  using namespace palpate::fuzz;
  const std::string_view name = count > 1 ? words[1] : "";
  const auto target =
      std::find_if(kTargets.begin(), kTargets.end(), [&](const Target& one) { return one.name == name; });
  if (target == kTargets.end()) {
    std::fprintf(stderr, "Usage: coverage TARGET FOLDER...\n");
    return 2;
  }
  for (int i = 2; i < count; ++i)
    for (const auto& entry : std::filesystem::directory_iterator(words[i])) {
      std::ifstream in(entry.path(), std::ios::binary);
      const std::vector<char> bytes(std::istreambuf_iterator<char>(in), {});
      (void)target->read({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    }
}
