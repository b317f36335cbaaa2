// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "page_message.h"
#include "palpate/idl/writer.h"

namespace palpate::viewer {

/// Merges two requests; later values replace earlier ones.
[[nodiscard]] SetParameters merged(const SetParameters& earlier, const SetParameters& later);

/// The request on the wire. @param[in] model_youngs_modulus  E that the factor multiplies, Pa
[[nodiscard]] dds::ParameterRequest requestOf(const SetParameters& wanted, double model_youngs_modulus);

/// Passes pages' parameter requests to the server, one at a time per page. Requests that come meanwhile are merged, so
/// that a dragged slider leaves no queue. Threads: one, the web thread.
class ParameterDesk {
 public:
  static constexpr std::int64_t kRepeatNs = 200'000'000;
  static constexpr std::int64_t kPatienceNs = 3'000'000'000;

  /// The outcome of a page's requests up to and including `request`.
  struct Answer {
    std::uint64_t page_id;
    std::uint64_t request;
    bool accepted;
    std::string message;
  };

  /// A participant whose role may not write requests refuses them itself. @throw dds::DdsError
  explicit ParameterDesk(const dds::Participant& participant);

  void set(std::uint64_t page_id, const SetParameters& wanted);
  void drop(std::uint64_t page_id) { wishes_.erase(page_id); }

  /// A server's answer came, to this or another client.
  void saw(const dds::ServerParameters& answer);
  /// Sends requests and repeats them.
  /// @param[in] server  parameters of the server to ask; nothing: there is none, or it has not sent them
  void tend(const std::optional<dds::ServerParameters>& server, std::int64_t now_ns);

  [[nodiscard]] std::vector<Answer> answers() { return std::exchange(answers_, {}); }

 private:
  struct Wish {
    std::optional<SetParameters> asked;    // awaits the server's answer
    std::optional<SetParameters> waiting;  // the page's next
    dds::ParameterRequest request{};
    std::int64_t since_ns{0};
    std::int64_t sent_ns{0};
  };
  bool startNext(std::uint64_t page_id, Wish& wish, const std::optional<dds::ServerParameters>& server,
                 std::int64_t now_ns);

  std::optional<dds::Writer<dds::ParameterRequest>> writer_;  // where the identity may
  std::uint64_t next_id_;
  std::map<std::uint64_t, Wish> wishes_;  // by page
  std::vector<Answer> answers_;
};

}  // namespace palpate::viewer
