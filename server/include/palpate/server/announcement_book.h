// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <vector>

#include "palpate/idl/reader.h"

namespace palpate::server {

/// The newest word of each writer about each tool. A writer that repeats itself says nothing new. Keeps kMost words: whoever
/// floods replaces his own. Knows no DDS entity.
/// Threads: DDS's receive threads hear, one other asks. The receive threads never wait for the lock: drivers repeat their words.
/// Real-time: hearing allocates nothing.
class AnnouncementBook {
 public:
  static constexpr std::size_t kMost = 64;

  struct Said {
    dds::WriterId writer{0};  ///< 0: a free place
    std::uint64_t number{0};  ///< rises with each word that is new
    dds::ToolAnnouncement what{};
  };

  /// @return false: there is no place for it
  bool heard(const dds::ToolAnnouncement& what, dds::WriterId writer) noexcept;

  [[nodiscard]] std::vector<Said> said() const;
  void forget(dds::WriterId writer);
  /// Whose words take the place of others where there is none left.
  void prefer(std::vector<dds::WriterId> writers);

 private:
  [[nodiscard]] Said* place(const dds::ToolAnnouncement& what, dds::WriterId writer) noexcept;
  [[nodiscard]] bool isPreferred(dds::WriterId writer) const noexcept;

  mutable std::mutex mutex_;  // what is below
  std::array<Said, kMost> said_{};
  std::vector<dds::WriterId> preferred_;
  std::uint64_t heard_{0};
};

}  // namespace palpate::server
