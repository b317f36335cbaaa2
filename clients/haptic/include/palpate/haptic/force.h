// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace palpate::haptic {

using Vec3 = std::array<double, 3>;  ///< x, y, z in the world frame W, that of the organ's mesh

/// The force on the tool at one moment, and its context.
struct Force {
  Vec3 force{};                ///< on the tool in W, N: what the device renders. Never larger than the limits
  Vec3 anchor{};               ///< X(s): rest position of the touched material point, m
  Vec3 proxy{};                ///< current position of that point, m: draw the tool resting here
  double age_s{0.0};           ///< time since the newest answer, s; infinity before the first one
  double gain{0.0};            ///< the watchdog's gain, 0 to 1, already in `force`
  std::uint64_t pose_seq{0};   ///< the answered pose, as send() returned it; 0 before the first answer
  std::uint32_t flags{0};      ///< FLAG_* of palpate.idl, PALPATE_HAPTIC_FLAG_* of palpate_haptic.h
  std::uint32_t state{0};      ///< 0 free, 1 stick, 2 slide
  std::uint32_t server_id{0};  ///< of the server whose force it is
  std::uint64_t session{
      0};  ///< of the run of that server, random; another one: another server has taken over. 0 before the first answer
};

}  // namespace palpate::haptic
