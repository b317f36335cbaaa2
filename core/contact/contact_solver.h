// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/budget.h"
#include "core/base/types.h"
#include "core/contact/contact.h"
#include "core/contact/coupling.h"
#include "core/model/meta_model.h"

namespace palpate {

/// What is known of a tip's way from its last pose to this one.
enum class TipWay : std::uint8_t {
  kStraight,  ///< so short that it is taken as straight: the tip is swept along it
  kUnseen,  ///< it may have gone round the organ: free if it is clear of it; else it keeps its side where it is near
            ///< enough to have stayed
  kNone,  ///< it leapt: the contact is forgotten, and a tool that is inside has the side of the nearest point
};

/// Moves a tool through free, stick and slide                                         docs/design.md, Contact
///   free -> stick:  the tip's sphere touched the contact surface, as other tools displaced it, on its way from the last
///                   pose to this one (TipSweep), and is below that sheet still. The anchor is the point of the sheet that the tip
///                   lies straight above or below, c = X(s) + h n(s), h < R, so that the force begins at zero or along n(s)
///   stick, slide:   the anchor's force balance and Coulomb's law (Equilibrium). At the border of the accessible part
///                   the anchor stops, flagged kNotAccessible. However deep the tip, the anchor stays on its sheet
///   -> free:        f . n > 0, the tool would pull; or the tip's sphere, grown by 0.5 mm, has left the contact
///                   surface round the anchor, as this tool and the others displaced it: a tool drawn off sideways is not held
///                   from afar, and a thin part that bends away is held while it pushes
/// The direction from anchor to tip is n(s) itself, not the one at capture. So g depends on where the anchor is, not on its
/// path, and the surface that a tip of radius R slides on, X(s) + R n(s), has no edges.
/// A tool at its first pose that is inside at once has the side of the nearest point.
class ContactSolver {
 public:
  explicit ContactSolver(double tip_radius) noexcept : tip_radius_(tip_radius) {}
  [[nodiscard]] double tipRadius() const noexcept PALPATE_NONBLOCKING { return tip_radius_; }

  /// One tick of one tool. @param c  tip centre, W, m, finite. At most one change between free and not free.
  /// Sets `jump` where the force is not continuous in c. A budget that ends leaves the best balance found,
  /// kAnswerCutShort; the next tick goes on from there.
  /// @return false when the model's answer is not finite: the contact is as it was. Real-time: yes.
  bool update(const MetaModel& model, const ContactLaw& law, const Vec3& c, TipWay way, Budget& budget,
              Contact& contact) const noexcept PALPATE_NONBLOCKING;
  /// The same for a straight way, with a budget for this tick alone.
  bool update(const MetaModel& model, const ContactLaw& law, const Vec3& c,
              Contact& contact) const noexcept PALPATE_NONBLOCKING {
    Budget budget;
    return update(model, law, c, TipWay::kStraight, budget, contact);
  }
  /// Frees the tool: no force, no displacement; the anchor stays as the nearest point known. Real-time: yes.
  static void release(Contact& contact) noexcept PALPATE_NONBLOCKING;
  /// release(), and forgets which side the tool came from and what the others carried it. Real-time: yes.
  static void forget(Contact& contact) noexcept PALPATE_NONBLOCKING;

 private:
  void loseWay(const MetaModel& model, const Vec3& c, Contact& contact) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] Vec3 touching(const MetaModel& model,
                              const Contact& contact) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool hasLeft(const MetaModel& model, const Vec3& at_rest,
                             const Contact& contact) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool arrivesBelow(const MetaModel& model, const Vec3& at_rest, bool was_below,
                                  Contact& contact) const noexcept PALPATE_NONBLOCKING;
  [[nodiscard]] bool settlesBelow(const MetaModel& model, const Vec3& at_rest,
                                  Contact& contact) const noexcept PALPATE_NONBLOCKING;
  void tryCapture(const MetaModel& model, const ContactLaw& law, const Vec3& c, Budget& budget,
                  Contact& contact) const noexcept PALPATE_NONBLOCKING;
  void follow(const MetaModel& model, const ContactLaw& law, const Vec3& c, Budget& budget,
              Contact& contact) const noexcept PALPATE_NONBLOCKING;
  void hold(const MetaModel& model, const ContactLaw& law, const Vec3& c, Budget& budget,
            Contact& contact) const noexcept PALPATE_NONBLOCKING;

  double tip_radius_;
};

}  // namespace palpate
