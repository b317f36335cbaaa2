// SPDX-License-Identifier: Apache-2.0
// What pages may do follows from the role of the viewer that serves them.
#include <gtest/gtest.h>

#include "authority_folder.h"
#include "palpate/testing/test_domain.h"
#include "parameter_desk.h"
#include "tool_desk.h"

namespace palpate::viewer {
namespace {

class PageRoles : public ::testing::Test {
 protected:
  [[nodiscard]] dds::Participant join(const std::string& role) const {
    return dds::Participant(testing::exclusiveDomain(), dds::Identity::load(authority_.of(role)));
  }
  // Whether a page of that role gets a tool, and what it is told.
  [[nodiscard]] static ToolGrant grab(const dds::Participant& participant) {
    ToolDesk desk(participant, {3});
    desk.setServer({1, 0, 4, 2.0});
    return desk.grab(1);
  }
  // What a page of that role is told that sets friction while no server has said its parameters.
  [[nodiscard]] static std::string set(const dds::Participant& participant) {
    ParameterDesk desk(participant);
    SetParameters wanted{};
    wanted.friction = 0.1;
    desk.set(1, wanted);
    desk.tend(std::nullopt, 0);
    return desk.answers().at(0).message;
  }

  const testing::AuthorityFolder authority_;
};

TEST_F(PageRoles, AViewersPageLooksOnly) {
  const dds::Participant participant = join("viewer");
  EXPECT_FALSE(grab(participant).granted);
  EXPECT_EQ(grab(participant).message, "this page may look only");
  EXPECT_EQ(set(participant), "this page may not change parameters");
}

TEST_F(PageRoles, ADriversPageMovesAToolAndSetsNothing) {
  const dds::Participant participant = join("driver");
  EXPECT_TRUE(grab(participant).granted);
  EXPECT_EQ(set(participant), "this page may not change parameters");
}

TEST_F(PageRoles, AnOperatorsPageDoesBoth) {
  const dds::Participant participant = join("operator");
  EXPECT_TRUE(grab(participant).granted);
  EXPECT_EQ(set(participant), "no server has said its parameters yet");
}

}  // namespace
}  // namespace palpate::viewer
