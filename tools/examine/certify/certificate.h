// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/meta_model.h"
#include "tools/examine/certify/examination.h"
#include "tools/examine/certify/pair_examination.h"
#include "tools/examine/certify/travel.h"
#include "tools/program/json.h"

namespace palpate::certify {

/// How the touches were drawn.
struct Drawing {
  Travel travel;
  TouchRange range;
  std::uint64_t seed;
};

/// What the file keeps: keys in docs/json.md, meaning in docs/design.md, Certificate. The same for the same content, however
/// many threads there were.
[[nodiscard]] program::Json certificateOf(const MetaModel& model, const Drawing& drawing,
                                          const Examination& found);

/// What the certificate says of two tools, as its "two_tools". @param pairs  all that were drawn
[[nodiscard]] program::Json pairsOf(const MetaModel& model, const std::vector<PairFinding>& pairs);

/// Every touch that was drawn, for --json. docs/json.md
[[nodiscard]] program::Json touchesOf(const Examination& found);

/// The certificate for a person to read, several lines.
[[nodiscard]] std::string toText(const program::Json& certificate, const Drawing& drawing);

}  // namespace palpate::certify
