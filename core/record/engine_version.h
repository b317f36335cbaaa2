// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::record {

/// Which engine gave a recording's answers.
struct EngineVersion {
  std::array<char, 16> project{};  ///< "0.1.0", zeros behind it
  std::uint32_t answers{0};

  [[nodiscard]] bool operator==(const EngineVersion&) const noexcept = default;
  /// "0.1.0, answers 1", whatever the file holds.
  [[nodiscard]] std::string text() const {
    std::string name;
    for (const char c : project)
      if (c > ' ' && c <= '~') name += c;
    return name + ", answers " + std::to_string(answers);
  }
};

/// This one's. Raise `answers` whenever step() answers any input with another bit.
[[nodiscard]] inline EngineVersion thisEngine() noexcept {
  constexpr std::uint32_t kAnswers = 4;
  constexpr std::string_view kProject = PALPATE_VERSION;
  EngineVersion engine{{}, kAnswers};
  static_assert(kProject.size() <= engine.project.size());
  kProject.copy(engine.project.data(), kProject.size());
  return engine;
}

}  // namespace palpate::record
