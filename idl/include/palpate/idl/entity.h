// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <utility>

namespace palpate::dds {

/// Owns one Cyclone DDS entity. Move only. Deleting waits until its listener callbacks have returned.
/// Real-time: no.
class Entity {
 public:
  Entity() noexcept = default;
  explicit Entity(dds_entity_t handle) noexcept : handle_(handle) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    if (this != &other) {
      reset();
      handle_ = std::exchange(other.handle_, 0);
    }
    return *this;
  }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  ~Entity() { reset(); }

  [[nodiscard]] dds_entity_t handle() const noexcept { return handle_; }

 private:
  // A parent deletes its children too; deleting a child afterwards is an error that Cyclone reports and we
  // expect.
  void reset() noexcept {
    if (handle_ > 0) dds_delete(std::exchange(handle_, 0));
  }

  dds_entity_t handle_{0};
};

}  // namespace palpate::dds
