// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palpate::bench {

/// Registers field/<nodes>x<modes>/palpate, /eigen_f32 and /plain_read, on synthetic models, each made when
/// its benchmark begins. The counters come from a race of the three (field_race.h), one for each size; the
/// time that Google Benchmark prints is that of each loop by itself. @param[in] seconds  of a loop, a third
/// of a race
void registerFields(double seconds);

}  // namespace palpate::bench
