// SPDX-License-Identifier: Apache-2.0
// What is in force, as one is told who may send no request: the servers' last answers, to whomever.
#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "authority_folder.h"
#include "palpate/client/error.h"
#include "palpate/client/parameter_exchange.h"
#include "palpate/idl/writer.h"
#include "palpate/testing/test_domain.h"

namespace palpate::client {
namespace {

using namespace std::chrono_literals;

class ParameterAnswer : public ::testing::Test {
 protected:
  // A server, as far as this needs one.
  struct Server {
    explicit Server(const dds::Identity& identity, std::uint32_t id = 0)
        : server_id(id), participant(palpate::testing::exclusiveDomain(), identity) {}
    void answer(std::uint64_t session, std::uint64_t revision, bool pending) {
      dds::ServerParameters said{};
      said.server_id = server_id;
      said.session = session;
      said.revision = revision;
      said.pending = pending;
      EXPECT_TRUE(answers.write(said));
    }
    std::uint32_t server_id{0};
    dds::Participant participant;
    dds::Writer<dds::ServerParameters> answers{participant};
  };

  [[nodiscard]] dds::ServerParameters ask(std::uint64_t session, std::chrono::milliseconds patience,
                                          std::uint32_t server_id = 0) const {
    const dds::Participant viewer(palpate::testing::exclusiveDomain(),
                                  dds::Identity::load(authority_.of("viewer")));
    dds::ParameterRequest question{};
    question.server_id = server_id;
    question.session = session;
    return exchangeParameters(viewer, question, patience);
  }

  const palpate::testing::AuthorityFolder authority_;
  const dds::Identity identity_ = dds::Identity::load(authority_.of("server"));
  Server server_{identity_};
};

TEST_F(ParameterAnswer, IsTheOneThatWasKept) {
  server_.answer(1, 3, false);
  server_.answer(1, 4, false);
  EXPECT_EQ(ask(0, 5s).revision, 4U);
}

TEST_F(ParameterAnswer, ThatSaysThatAnotherFollowsIsWaitedFor) {
  server_.answer(1, 3, true);
  auto asked = std::async(std::launch::async, [&] { return ask(0, 5s); });
  EXPECT_EQ(asked.wait_for(300ms), std::future_status::timeout);
  server_.answer(1, 4, false);
  EXPECT_EQ(asked.get().revision, 4U);
}

TEST_F(ParameterAnswer, OfTwoServersOfOneIdIsRefused) {
  Server second(identity_);
  server_.answer(1, 3, false);
  second.answer(2, 5, false);
  try {
    (void)ask(0, 5s);
    FAIL() << "one of two was taken";
  } catch (const ClientError& error) {
    EXPECT_NE(std::string(error.what()).find("2 servers have the id 0 and each answers for itself"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(ask(2, 5s).revision, 5U) << "asked of one run";
}

// Where the machine is busy the second answer may come later than it was sent: then with servers that nobody has heard before.
TEST_F(ParameterAnswer, OfASecondServerIsWaitedForAWhile) {
  bool refused = false;
  for (std::uint32_t id = 1; id <= 5 && !refused; ++id) {
    Server first(identity_, id), second(identity_, id);
    auto asked = std::async(std::launch::async, [&] { return ask(0, 20s, id); });
    std::this_thread::sleep_for(500ms);  // until all have met
    first.answer(1, 3, false);
    std::this_thread::sleep_for(100ms);
    second.answer(2, 5, false);
    try {
      (void)asked.get();
    } catch (const ClientError&) {
      refused = true;
    }
  }
  EXPECT_TRUE(refused);
}

TEST_F(ParameterAnswer, OfNoServerIsAnError) {
  EXPECT_THROW((void)ask(7, 100ms), ClientError);
}

}  // namespace
}  // namespace palpate::client
