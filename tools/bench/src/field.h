// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::bench {

/// Registers field/<nodes>x<modes>/palpate, /eigen_f32 and /plain_read, on synthetic models that are made
/// when their turn comes. The counters come from a race of the three (field_race.h), held once for each size;
/// what Google Benchmark prints as time is each one's loop by itself. @param[in] seconds  of a loop, a third
/// of a race
void registerFields(double seconds);

}  // namespace palpate::bench
