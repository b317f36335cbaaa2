// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "palpate/rt/token_bucket.h"

namespace palpate::viewer {

/// Bounds how often secrets are guessed: 10 wrong ones at once from one address, then 10 per minute. At most 256
/// addresses are told apart; the others share one bound. Threads: one.
class Attempts {
 public:
  /// Counts an attempt. @param[in] peer  numeric address; one network of IPv6 (/64) counts as one
  /// @return false when there were too many
  [[nodiscard]] bool take(std::string_view peer, std::int64_t now_ns);

  /// Forgets the attempts of one that knew the secret.
  void forgive(std::string_view peer);

 private:
  struct Count {
    rt::TokenBucket left;
    std::int64_t last_ns;
  };
  [[nodiscard]] static Count fresh(std::int64_t now_ns);

  std::map<std::string, Count> peers_;
  Count others_{fresh(0)};
};

}  // namespace palpate::viewer
