// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <array>
#include <cstddef>
#include <utility>

namespace palpate::dds {

/// The most samples that one take hands over. With keep last 1 there is one per instance, so more than this
/// many tools, organs or servers need a second take.
inline constexpr std::size_t kMaxTake = 16;

/// Samples that belong to Cyclone until this goes out of scope. Holds only those with valid data. Move only.
template <class T>
class LoanedSamples {
 public:
  LoanedSamples() noexcept = default;

  /// Takes what `reader` has. Real-time: no, Cyclone allocates.
  explicit LoanedSamples(dds_entity_t reader) noexcept : reader_(reader) {
    std::array<dds_sample_info_t, kMaxTake> infos;
    const dds_return_t taken = dds_take(reader_, loan_.data(), infos.data(), kMaxTake, kMaxTake);
    loaned_ = taken > 0 ? taken : 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(loaned_); ++i)
      if (infos[i].valid_data) valid_[size_++] = static_cast<const T*>(loan_[i]);
  }
  LoanedSamples(LoanedSamples&& other) noexcept
      : reader_(other.reader_),
        loaned_(std::exchange(other.loaned_, 0)),
        size_(std::exchange(other.size_, 0)),
        loan_(other.loan_),
        valid_(other.valid_) {}
  LoanedSamples& operator=(LoanedSamples&&) = delete;
  LoanedSamples(const LoanedSamples&) = delete;
  LoanedSamples& operator=(const LoanedSamples&) = delete;
  ~LoanedSamples() {
    if (loaned_ > 0) dds_return_loan(reader_, loan_.data(), loaned_);
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return *valid_[i]; }

 private:
  dds_entity_t reader_{0};
  dds_return_t loaned_{0};
  std::size_t size_{0};
  std::array<void*, kMaxTake> loan_{};
  std::array<const T*, kMaxTake> valid_{};
};

}  // namespace palpate::dds
