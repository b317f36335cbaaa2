// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

namespace palpate {

/// Owns one HDF5 identifier (hid_t, which is an int64_t; herr_t is an int). A negative one is "none", so that
/// a failed call can be tested after it is wrapped. Does not include HDF5 itself; its users do.
class Hdf5Handle {
 public:
  using Close = int (*)(std::int64_t);
  Hdf5Handle(std::int64_t id, Close close) noexcept : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] bool valid() const noexcept { return id_ >= 0; }
  [[nodiscard]] std::int64_t get() const noexcept { return id_; }
  /// Closes it. @return false when HDF5 could not (for a file: could not write all of it)
  [[nodiscard]] bool closeNow() noexcept { return close_(std::exchange(id_, -1)) >= 0; }

 private:
  std::int64_t id_;
  Close close_;
};

}  // namespace palpate
