// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "palpate/idl/outsider_watch.h"

namespace palpate::server {

/// What there is to tell of a server with an identity: who is not let in, what DDS finds wrong with others' certificates and
/// permissions, and that its own end or have ended: DDS then leaves the domain, so that no pose comes any more.
/// While it lives, DDS logs here instead of to standard error; one at a time.
/// Threads: the polls on one; DDS logs on any. The participant must outlive it. Real-time: no.
class SecurityWatch {
 public:
  /// @param[in] participant  one with an identity
  explicit SecurityWatch(const dds::Participant& participant);
  ~SecurityWatch();
  SecurityWatch(const SecurityWatch&) = delete;
  SecurityWatch& operator=(const SecurityWatch&) = delete;

  /// Who was not let in, since the last call.
  [[nodiscard]] std::vector<std::string> pollOthers();
  /// What DDS logged since the last call: the first line, with the number of those that came behind it, since others decide how
  /// many there are.
  [[nodiscard]] std::vector<std::string> pollLines();
  /// That the own identity ends: 30 days before, at the first call and each day; and once, that it has. Empty: nothing to tell.
  /// Apart from others' lines, which may be left out.
  [[nodiscard]] std::string pollOwn(std::int64_t now_ns);

 private:
  static void onLine(void* self, const dds_log_data_t* line);

  const dds::Participant& participant_;
  dds::OutsiderWatch outsiders_;
  std::int64_t warned_ns_{0};  // 0: not yet
  bool expired_{false};
  std::mutex mutex_;  // what is below
  std::string line_;
  std::uint64_t more_{0};
};

}  // namespace palpate::server
