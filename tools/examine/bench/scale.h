// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::bench {

/// Prints, for each size, the time of a field with its near field on a synthetic model with `modes` modes,
/// and the largest size that fits: p99 below a millisecond, the period at 1 kHz. It begins at 20,000 surface
/// nodes and tries sizes up to 100,000 and down to 500. @return whether a size fits
bool printScale(int modes);

}  // namespace palpate::bench
