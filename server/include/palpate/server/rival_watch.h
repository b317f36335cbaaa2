// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "palpate/idl/tap.h"
#include "palpate/server/rival_book.h"
#include "palpate/server/status_publisher.h"

namespace palpate::server {

/// The server does not begin: another one answers the same poses. what() is one line: whose they are and what to do.
class RivalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What there is to say about rivals.
struct RivalNews {
  std::size_t count{0};
  std::string text;     ///< about one of them; empty: none
  bool starter{false};  ///< a rival has said that it starts
};

/// Sees to it that one server answers a pose. Before its first force a server says that it starts, listens, and ends if another
/// one answers the same poses already; of two that start at once the one with the lower GUID goes on. A server that runs never
/// stops for what it hears: it reports (docs/decisions/rival_servers.md).
/// Threads: one. Real-time: no.
class RivalWatch {
 public:
  /// Says each 100 ms that this server starts, and listens for `seconds`; up to 1.5 s longer where it hears forces and not yet
  /// whose they are; with 0 neither. Goes on hearing other servers afterwards. `facts` must outlive the watch.
  /// @throw RivalError (this server is not to begin), dds::DdsError
  RivalWatch(const dds::Participant& participant, const Facts& facts, StatusPublisher& status,
             double seconds);

  [[nodiscard]] RivalNews poll(std::int64_t now_ns);

 private:
  void takePlace(StatusPublisher& status, double seconds) const;
  [[nodiscard]] bool hearsNameless(std::int64_t now_ns) const;
  void refuseToJoin(std::int64_t now_ns, std::int64_t grace_ns) const;
  [[nodiscard]] bool goesFirst(const OtherServer& other) const;
  [[nodiscard]] std::string guidOf(const OtherServer& other) const;
  [[nodiscard]] std::string nameOf(const OtherServer& other) const;

  std::uint32_t domain_;
  std::string own_guid_;
  RivalBook book_;
  dds::Tap<dds::ServerStatus> statuses_;
  dds::Tap<dds::ToolForce> forces_;  // last, like the other: their callbacks use the book
};

}  // namespace palpate::server
