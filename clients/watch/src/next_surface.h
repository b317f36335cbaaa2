// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "palpate/client/surface.h"
#include "palpate/idl/reader.h"

namespace palpate::watch {

/// The rest surface that a server says after it took another model. Threads: take() on one; DDS's receive thread beside it.
class NextSurface {
 public:
  /// @param[in] now  the surface that is followed: that of the next one has the same session and organ. @throw dds::DdsError
  NextSurface(const dds::Participant& participant, const client::Surface& now);

  /// The newest one of another model than the last one here; nothing: none has come.
  [[nodiscard]] std::shared_ptr<const client::Surface> take();

 private:
  static bool onSurface(const dds::SurfaceMesh& message, void* context) noexcept;

  std::uint64_t session_;
  std::uint32_t organ_id_;
  std::mutex mutex_;  // the next two
  std::string model_id_;
  std::shared_ptr<const client::Surface> next_;
  dds::Reader<dds::SurfaceMesh> reader_;  // last: its filter uses the rest
};

}  // namespace palpate::watch
