// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <span>
#include <string>

#include "palpate/idl/error.h"
#include "palpate/idl/loaned_samples.h"
#include "palpate/idl/mismatch.h"
#include "palpate/idl/topic.h"

namespace palpate::dds {

/// Names the writer of a sample, within this process: a sender that restarts gets a new one.
using WriterId = dds_instance_handle_t;

/// What a data callback gets: the reader, without owning it.
template <class T>
class ReaderView {
 public:
  explicit ReaderView(dds_entity_t handle) noexcept : handle_(handle) {}

  /// Takes samples into the caller's memory: those with valid data, at most min(out.size(), kMaxTake).
  /// @return how many of `out` were filled; 0 when there is nothing or Cyclone reports an error
  /// No allocation of ours; Cyclone locks. Threads: any; use one, or samples are shared out.
  [[nodiscard]] std::size_t take(std::span<T> out) const noexcept requires TopicTraits<T>::kFlat {
    std::array<WriterId, kMaxTake> writers;
    return take(out, writers);
  }

  /// The same, and who sent each of them. @param[out] writers  kMaxTake of them
  [[nodiscard]] std::size_t take(
      std::span<T> out, std::span<WriterId, kMaxTake> writers) const noexcept requires TopicTraits<T>::kFlat {
    std::array<void*, kMaxTake> buffers;
    std::array<dds_sample_info_t, kMaxTake> infos;
    const auto wanted = static_cast<std::uint32_t>(std::min(out.size(), kMaxTake));
    if (wanted == 0) return 0;
    for (std::uint32_t i = 0; i < wanted; ++i) buffers[i] = &out[i];
    const dds_return_t taken = dds_take(handle_, buffers.data(), infos.data(), wanted, wanted);
    std::size_t valid = 0;
    for (std::size_t i = 0; taken > 0 && i < static_cast<std::size_t>(taken); ++i) {
      if (!infos[i].valid_data) continue;
      if (valid != i) out[valid] = out[i];
      writers[valid] = infos[i].publication_handle;
      ++valid;
    }
    return valid;
  }

  /// Takes samples that stay in Cyclone's memory: the way for types with sequences.
  [[nodiscard]] LoanedSamples<T> takeLoaned() const noexcept { return LoanedSamples<T>(handle_); }

 private:
  dds_entity_t handle_;
};

/// Called when data has come, on Cyclone's receive thread, or on the writer's thread when both are in one
/// process. Must take the data, must not block, throw, or delete the reader.
template <class T>
using DataCallback = void (*)(ReaderView<T> reader, void* context) noexcept;

/// Asked before a sample is kept: false and Cyclone forgets it, its instance too. Not asked when a writer disposes of an
/// instance. One call at a time, on the receive
/// thread, possibly while the data callback runs on another; must not block, throw, or use the reader.
template <class T>
using SampleFilter = bool (*)(const T& sample, void* context) noexcept;

/// Called when a writer that was matched is so no more: it was deleted, or its process went silent for DDS's lease. Samples of it
/// that came before may still wait in the reader. On Cyclone's discovery thread; must not block, throw, or use the reader.
using GoneCallback = void (*)(WriterId writer, void* context) noexcept;

/// Receives samples of T. The participant must outlive it.
template <class T>
class Reader {
 public:
  using Traits = TopicTraits<T>;
  static constexpr bool kWrites = false;

  /// Without a callback: take() when you like.
  /// @throw DdsError naming the topic
  /// Real-time: no.
  explicit Reader(const Participant& participant) : Reader(participant, nullptr, nullptr) {}

  /// With a callback, from before the first sample on. `context` is passed through and must outlive the
  /// reader. `admits`, if given, is asked first, and `gone` told of writers, with the same context.
  Reader(const Participant& participant, DataCallback<T> callback, void* context,
         SampleFilter<T> admits = nullptr, GoneCallback gone = nullptr)
      : binding_(std::make_unique<Binding>(Binding{callback, context, admits, gone})), topic_(participant) {
    if (admits != nullptr) filter();
    dds_listener_t* listener = nullptr;
    if (callback != nullptr) {
      listener = dds_create_listener(nullptr);
      dds_lset_data_available_arg(listener, &Reader::onData, binding_.get(), false);
      // true: each call has the change since the last one. With false Cyclone adds them up until somebody asks for the status.
      if (gone != nullptr)
        dds_lset_subscription_matched_arg(listener, &Reader::onMatched, binding_.get(), true);
    }
    const std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)> owner(listener,
                                                                                &dds_delete_listener);
    entity_ = Entity(
        raw::createReader(participant.handle(), topic_.handle(), Traits::kName, Traits::kProfile, listener));
  }

  [[nodiscard]] std::size_t take(std::span<T> out) const noexcept requires Traits::kFlat {
    return view().take(out);
  }
  [[nodiscard]] LoanedSamples<T> takeLoaned() const noexcept { return view().takeLoaned(); }
  [[nodiscard]] ReaderView<T> view() const noexcept { return ReaderView<T>(entity_.handle()); }

  [[nodiscard]] unsigned matched() const noexcept { return raw::matchedWriters(entity_.handle()); }
  /// @return whether at least `count` writers matched within `timeout`
  [[nodiscard]] bool waitForWriters(unsigned count, std::chrono::milliseconds timeout) const noexcept {
    return raw::waitUntilMatched(&raw::matchedWriters, entity_.handle(), count, timeout);
  }
  /// One line when a writer was found whose type or QoS does not fit; else empty.
  [[nodiscard]] std::string mismatch() const { return mismatchOf(entity_.handle(), false); }
  [[nodiscard]] dds_entity_t handle() const noexcept { return entity_.handle(); }

 private:
  struct Binding {
    DataCallback<T> callback;
    void* context;
    SampleFilter<T> admits;
    GoneCallback gone;
  };
  void filter() {
    dds_topic_filter filter{};
    filter.mode = DDS_TOPIC_FILTER_SAMPLE_ARG;
    filter.f.sample_arg = &Reader::onFilter;
    filter.arg = binding_.get();
    checked(dds_set_topic_filter_extended(topic_.handle(), &filter),
            std::string("cannot filter topic ") + Traits::kName);
  }
  static bool onFilter(const void* sample, void* arg) {
    const auto* binding = static_cast<const Binding*>(arg);
    return binding->admits(*static_cast<const T*>(sample), binding->context);
  }
  static void onData(dds_entity_t reader, void* arg) {
    const auto* binding = static_cast<const Binding*>(arg);
    binding->callback(ReaderView<T>(reader), binding->context);
  }
  static void onMatched(dds_entity_t, dds_subscription_matched_status_t status, void* arg) {
    const auto* binding = static_cast<const Binding*>(arg);
    if (status.current_count_change < 0) binding->gone(status.last_publication_handle, binding->context);
  }

  std::unique_ptr<Binding> binding_;  // on the heap: the listener keeps its address while the Reader may move
  Topic<T> topic_;
  Entity entity_;  // last, so that it goes first and no callback outlives the binding
};

}  // namespace palpate::dds
