// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "palpate/idl/error.h"
#include "palpate/idl/mismatch.h"
#include "palpate/idl/reader.h"

namespace palpate::dds {

/// Whose samples a Tap hears.
enum class Hears {
  kAll,
  kOthers  ///< not those of its own participant
};

/// What a Tap hears of the time before it.
enum class Wants {
  kNew,     ///< nothing. Every writer matches
  kHistory  ///< what a latched writer keeps. Asks for the topic's own QoS: a flood of disposed ids is not bounded, so not for long
};

/// Hears each sample as it comes and keeps none: Cyclone's cache stays empty, so no flood fills it, and no writer's sample
/// replaces another's. Works as a filter that admits nothing. Cyclone asks the filter before it looks for room, but not about the
/// end of an instance, of which a reader that wants kNew notes kMaxInstances at most. The participant must outlive it.
template <class T>
class Tap {
 public:
  using Traits = TopicTraits<T>;
  /// One call at a time, on Cyclone's receive thread or on the writer's when both are in one process. Must not block, throw, or
  /// use the tap.
  using Callback = void (*)(const T& sample, WriterId writer, void* context) noexcept;

  /// @throw DdsError naming the topic
  /// Real-time: no.
  Tap(const Participant& participant, Callback heard, void* context, Hears whose = Hears::kAll,
      Wants wants = Wants::kNew)
      : binding_(std::make_unique<Binding>(Binding{heard, context})), topic_(participant) {
    dds_topic_filter filter{};
    filter.mode = DDS_TOPIC_FILTER_SAMPLE_SAMPLEINFO_ARG;
    filter.f.sample_sampleinfo_arg = &Tap::onSample;
    filter.arg = binding_.get();
    checked(dds_set_topic_filter_extended(topic_.handle(), &filter),
            std::string("cannot filter topic ") + Traits::kName);
    const std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)> listener(
        dds_create_listener(nullptr), &dds_delete_listener);
    dds_lset_data_available(listener.get(), &Tap::onRest);
    entity_ = Entity(raw::createReader(
        participant.handle(), topic_.handle(), Traits::kName, Traits::kProfile, listener.get(),
        wants == Wants::kHistory ? Endpoint::kReader : Endpoint::kTap, whose == Hears::kOthers));
  }

  [[nodiscard]] unsigned matched() const noexcept { return raw::matchedWriters(entity_.handle()); }
  [[nodiscard]] bool waitForWriters(unsigned count, std::chrono::milliseconds timeout) const noexcept {
    return raw::waitUntilMatched(&raw::matchedWriters, entity_.handle(), count, timeout);
  }
  [[nodiscard]] dds_entity_t handle() const noexcept { return entity_.handle(); }
  [[nodiscard]] std::string mismatch() const { return mismatchOf(entity_.handle(), false); }
  /// GUID of a writer's participant, 32 hexadecimal digits; empty when the writer is gone.
  [[nodiscard]] std::string participantOf(WriterId writer) const {
    return raw::participantGuid(entity_.handle(), writer);
  }

 private:
  struct Binding {
    Callback heard;
    void* context;
  };
  static bool onSample(const void* sample, const dds_sample_info_t* info, void* arg) {
    const auto* binding = static_cast<const Binding*>(arg);
    binding->heard(*static_cast<const T*>(sample), info->publication_handle, binding->context);
    return false;
  }
  // No filter is asked about the end of an instance.
  static void onRest(dds_entity_t reader, void*) { (void)LoanedSamples<T>(reader); }

  std::unique_ptr<Binding> binding_;  // on the heap: the filter keeps its address while the Tap may move
  Topic<T> topic_;
  Entity entity_;  // last, so that it goes first and no callback outlives the binding
};

}  // namespace palpate::dds
