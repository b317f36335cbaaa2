// SPDX-License-Identifier: Apache-2.0
// Where a contact's force is not continuous in the tip's place, and what becomes of one that cannot be answered.
#include <gtest/gtest.h>

#include "../round_organ.h"

namespace palpate::testing {

namespace {

const ContactSolver kSolver{StepConfig{}.tip_radius};

/// In contact, 2 mm deep, gone there slowly.
Contact pressing(const ContactLaw& law) {
  Contact contact;
  for (double z = -0.002; z < 0.002; z += 1e-4) kSolver.update(roundOrgan(), law, above(z), contact);
  return contact;
}

}  // namespace

TEST(ContactJump, ASlowPressHasNone) {
  const ContactLaw law{.friction = 0.3};
  Contact contact;
  for (double z = -0.002; z < 0.004; z += 1e-4) {
    ASSERT_TRUE(kSolver.update(roundOrgan(), law, above(z), contact));
    ASSERT_EQ(contact.jump, ContactJump::kNone) << z;
  }
  EXPECT_FALSE(contact.isFree());
}

TEST(ContactJump, IsACaptureThatIsDeepAtOnce) {
  Contact contact;
  kSolver.update(roundOrgan(), {}, above(0.004), contact);
  EXPECT_EQ(contact.jump, ContactJump::kDeepCapture);
}

TEST(ContactJump, IsAReleaseThatLeavesAForce) {
  const ContactLaw law{.friction = kInfinity};
  Contact contact = pressing(law);
  const auto go = [&](double depth, double aside) {
    kSolver.update(roundOrgan(), law, above(depth, aside), contact);
  };
  for (double aside = 0.0; aside < 0.002; aside += 1e-4) go(0.002, aside);  // the anchor sticks
  for (double depth = 0.002; !contact.isFree() && depth > -0.002; depth -= 1e-4) go(depth, 0.002);
  EXPECT_TRUE(contact.isFree());
  EXPECT_EQ(contact.jump, ContactJump::kReleasedWithForce);
}

TEST(ContactJump, IsAToolThatLeftWhileNobodySaw) {
  const ContactLaw law{.friction = 0.3};
  Contact contact = pressing(law);
  Budget budget;
  kSolver.update(roundOrgan(), law, above(-0.01), TipWay::kUnseen, budget, contact);
  EXPECT_TRUE(contact.isFree());
  EXPECT_EQ(contact.jump, ContactJump::kLeftUnseen);
}

TEST(ContactJump, ATipThatLeaptIsEngagedFromTheNearestSide) {
  const ContactLaw law{.friction = 0.3};
  Contact contact = pressing(law);
  Budget budget;
  kSolver.update(roundOrgan(), law, over(2.0, 0.003), TipWay::kNone, budget, contact);
  EXPECT_FALSE(contact.isFree());
  EXPECT_GT(contact.normal.dot(over(2.0, 0.003).normalized()), 0.99);
  EXPECT_EQ(contact.jump, ContactJump::kDeepCapture);
}

TEST(ContactJump, AnAnswerThatIsNotFiniteLeavesTheContactAsItWas) {
  const ContactLaw law{.friction = 0.3}, overflowing{.friction = 0.3, .stiffness_scale = 1e308};
  Contact contact = pressing(law);
  const Contact before = contact;
  EXPECT_FALSE(kSolver.update(roundOrgan(), overflowing, above(0.003), contact));
  EXPECT_EQ(contact.coupled.response.force, before.coupled.response.force);
  EXPECT_EQ(contact.anchor, before.anchor);
  EXPECT_EQ(contact.imposed, before.imposed);
}

}  // namespace palpate::testing
