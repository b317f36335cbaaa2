// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "palpate/idl/participant_of.h"
#include "palpate/idl/types.h"
#include "palpate/server/facts.h"
#include "palpate/server/live_limits.h"

namespace palpate::server {

/// What a driver says of its device.
struct DriverWord {
  std::uint64_t number{0};  ///< of all words heard; never 0
  dds::ParticipantId by{};
  dds::ToolAnnouncement what{};
};

/// The parameters that may change while the server runs: what is in force, and who may change what. Knows no DDS
/// entity. Threads: one. Real-time: no.
class ParameterBook {
 public:
  /// Starts from the values of the start, and keeps the operator's limits.
  /// @throw std::invalid_argument  limits of E leave out what the organ starts with
  explicit ParameterBook(const Facts& facts);

  /// Takes a request whole or not at all.
  /// @return the answer: accepted, or why not in one sentence with field, number and range; and what is in force now
  [[nodiscard]] dds::ServerParameters decide(const dds::ParameterRequest& request);

  /// What the driver of a tool says of its device now; nothing: no driver does. A word that is refused changes nothing, unless
  /// it is another driver's: then what the tool was started with is back.
  /// @return whether something changed, for the answer and the log
  [[nodiscard]] bool announced(std::size_t tool, const std::optional<DriverWord>& said);
  /// Why what a tool's driver says is refused; empty: it is not.
  [[nodiscard]] const std::string& refusal(std::size_t tool) const noexcept { return tools_[tool].refusal; }

  /// The values in force, as an answer without a request.
  [[nodiscard]] dds::ServerParameters answer() const;

  /// What is in force, as text: "device touch, tip_radius 0.005 m, youngs_modulus 160000 Pa (the model's), ...; tool 1: ...",
  /// naming the tools that differ from tool 0.
  [[nodiscard]] std::string describe() const;

  /// Why another organ cannot be served with the limits of the start; empty: it can.
  [[nodiscard]] std::string complaintAbout(const OrganStiffness& organ) const;
  /// What tools have on another organ: E as at a start with it, the operator's or the model's own; all else as it is in force.
  [[nodiscard]] AllToolSettings inForceOnNext() const;
  /// Another organ is served from now on. @param[in] organ  complaintAbout() has nothing to say
  void take(const OrganStiffness& organ);

  [[nodiscard]] const AllToolSettings& inForce() const noexcept { return settings_; }
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

 private:
  [[nodiscard]] std::string complaintAbout(const dds::ParameterRequest& request,
                                           const AllToolSettings& wanted) const;
  [[nodiscard]] std::string describe(std::size_t tool) const;

  // What a tool was started with, and what its driver says.
  struct Tool {
    std::string start_device;
    ToolSettings start;
    LiveLimits start_limits;
    std::uint64_t said{0};                 // number of the newest word; 0: none
    std::optional<dds::ParticipantId> by;  // whose word holds
    std::string refusal;
  };
  [[nodiscard]] std::string adopt(std::size_t tool, const dds::ToolAnnouncement& said);
  [[nodiscard]] std::string overlay(const dds::ToolAnnouncement& said, const Tool& book,
                                    ToolSettings& wanted) const;
  void restore(std::size_t tool);

  std::uint32_t server_id_;
  bool open_;
  double start_youngs_modulus_;  // Pa; 0: the model's own
  LiveBounds bounds_;            // that the operator named
  OrganStiffness organ_;
  std::array<std::string, kMaxTools> device_;
  AllToolSettings settings_;
  std::array<LiveLimits, kMaxTools> limits_;
  std::optional<Bounds> tip_limits_;
  std::array<Tool, kMaxTools> tools_;
  std::uint64_t revision_{0};
};

}  // namespace palpate::server
