// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "palpate/idl/entity.h"
#include "palpate/idl/error.h"

namespace palpate::dds {

/// A reader of one of DDS's builtin topics. @throw DdsError
[[nodiscard]] inline Entity builtinReader(dds_entity_t participant, dds_entity_t topic) {
  return Entity(
      checked(dds_create_reader(participant, topic, nullptr, nullptr), "cannot read what DDS discovered"));
}

/// Samples of a builtin topic, borrowed from DDS as long as this lives.
class BuiltinSamples {
 public:
  static constexpr std::size_t kMost = 64;

  /// @param[in] most  1 to kMost
  BuiltinSamples(dds_entity_t reader, std::size_t most) : reader_(reader) {
    count_ = dds_take(reader_, samples_.data(), infos_.data(), most, static_cast<std::uint32_t>(most));
  }
  BuiltinSamples(const BuiltinSamples&) = delete;
  BuiltinSamples& operator=(const BuiltinSamples&) = delete;
  ~BuiltinSamples() {
    if (count_ > 0) dds_return_loan(reader_, samples_.data(), count_);
  }

  [[nodiscard]] std::size_t size() const { return count_ < 0 ? 0 : static_cast<std::size_t>(count_); }
  [[nodiscard]] dds_instance_handle_t instance(std::size_t i) const { return infos_[i].instance_handle; }
  /// @return null where the instance has left
  template <class T>
  [[nodiscard]] const T* alive(std::size_t i) const {
    const bool is = infos_[i].valid_data && infos_[i].instance_state == DDS_IST_ALIVE;
    return is ? static_cast<const T*>(samples_[i]) : nullptr;
  }

 private:
  dds_entity_t reader_;
  std::array<void*, kMost> samples_{};
  std::array<dds_sample_info_t, kMost> infos_;
  dds_return_t count_;
};

}  // namespace palpate::dds
