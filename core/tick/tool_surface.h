// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/tick/workspace.h"

namespace palpate {

/// The surface under all tools together; a tool whose force fades takes its dimple with it.   docs/design.md, Parts
/// Borrows the model. Real-time: yes.
class ToolSurface {
 public:
  /// Finds what each tool in contact adds, and how much of each mode that is. @param scratch  its amplitudes are found
  ToolSurface(const MetaModel& model, std::span<const ToolMemory, kMaxTools> tools,
              FieldScratch& scratch) noexcept PALPATE_NONBLOCKING;

  /// What the tools add, at most 2 kMaxTools.
  [[nodiscard]] std::span<const FieldSource> sources() const noexcept PALPATE_NONBLOCKING;
  /// The field at the tools' anchors, m; zero where a tool has none.
  /// @return false when the model overflows: u is zero there
  [[nodiscard]] bool atAnchors(std::span<Vec3, kMaxTools> u) const noexcept PALPATE_NONBLOCKING;

 private:
  const MetaModel& model_;
  const FieldScratch& scratch_;
  std::array<ContactPoint, kMaxTools> anchors_;
  std::array<FieldSource, 2 * kMaxTools> sources_;
  std::size_t count_{0};
};

/// The whole field of sources whose amplitudes scratch has. @param[out] u  [Ns][3] m
/// @return false when the model overflows: u is zero then. Real-time: yes.
[[nodiscard]] bool evaluateSurface(const MetaModel& model, std::span<const FieldSource> sources,
                                   FieldScratch& scratch, std::span<float> u) noexcept PALPATE_NONBLOCKING;

}  // namespace palpate
