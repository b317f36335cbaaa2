// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/budget.h"
#include "core/base/types.h"
#include "core/contact/contact.h"
#include "core/model/meta_model.h"

namespace palpate {

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
/// A tool without a way (its first pose, after a leap) that is inside at once has the side of the nearest point.
class ContactSolver {
 public:
  explicit ContactSolver(double tip_radius) noexcept : tip_radius_(tip_radius) {}
  [[nodiscard]] double tipRadius() const noexcept PALPATE_NONBLOCKING { return tip_radius_; }

  /// One tick of one tool. @param c  tip centre, W, m, finite. At most one change between free and not free.
  /// Sets `jumped` where the force is not continuous in c: at a release that leaves a tangential force, at a capture
  /// that is deep at once, and where the anchor snaps from one balance to another. A budget that ends leaves the best
  /// balance found, kAnswerCutShort; the next tick goes on from there. Real-time: yes.
  void update(const MetaModel& model, const ContactLaw& law, const Vec3& c, Budget& budget,
              Contact& contact) const noexcept PALPATE_NONBLOCKING;
  /// The same with a budget for this tick alone.
  void update(const MetaModel& model, const ContactLaw& law, const Vec3& c,
              Contact& contact) const noexcept PALPATE_NONBLOCKING {
    Budget budget;
    update(model, law, c, budget, contact);
  }
  /// Frees the tool: no force, no displacement; the anchor stays as the nearest point known. Real-time: yes.
  static void release(Contact& contact) noexcept PALPATE_NONBLOCKING;
  /// release(), and forgets which side the tool came from and what the others carried it. Real-time: yes.
  static void forget(Contact& contact) noexcept PALPATE_NONBLOCKING;
  /// Before update(), when nothing is known of the way to c: a tool that is clear of the surface there is free, one that is
  /// not, and near to where it was, keeps its side. Sets `jumped` where it takes a force away. Real-time: yes.
  void loseWay(const MetaModel& model, const Vec3& c, Contact& contact) const noexcept PALPATE_NONBLOCKING;

 private:
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
