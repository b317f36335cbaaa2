// SPDX-License-Identifier: Apache-2.0
// What a server tells of its own identity, while strangers bring lines of their own.
#include <dds/ddsrt/log.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>
#include <thread>

#include "authority_folder.h"
#include "palpate/idl/certificate.h"
#include "palpate/server/events.h"
#include "palpate/server/lines_in_turn.h"
#include "palpate/testing/test_domain.h"

namespace palpate::server {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class SecuredEvents : public ::testing::Test {
 protected:
  SecuredEvents() {
    auto sink = std::make_shared<spdlog::sinks::ostream_sink_st>(log_);
    sink->set_pattern("%v");
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", std::move(sink)));
    events_.watchSecurity(security_);
  }
  ~SecuredEvents() override { spdlog::set_default_logger(std::make_shared<spdlog::logger>("none")); }

  // A server's identity that ends within seconds.
  [[nodiscard]] dds::Identity ending() const {
    const auto folder = std::filesystem::path(authority_.of("server"));
    const std::string subject = dds::subjectOf(*dds::readCertificate(folder / "identity.pem"));
    const std::time_t end = std::time(nullptr) + 6;
    security::writeSigned(
        security::permissionsSigner(authority_.folder()),
        security::permissions(dds::Role::kServer, subject, dds::utcOf(end - 60), dds::utcOf(end)),
        folder / "permissions.p7s");
    return dds::Identity::load(folder);
  }
  // What is logged where strangers bring three lines at this time.
  [[nodiscard]] std::string told(std::int64_t now_ns) {
    log_.str("");
    for (int i = 0; i < 3; ++i) dds_log(DDS_LC_ERROR, "stranger", 1, "stranger", "of a stranger\n");
    events_.drain(now_ns);
    return log_.str();
  }

  std::ostringstream log_;
  std::unique_ptr<Channels> channels_ = std::make_unique<Channels>();
  Facts facts_;
  const palpate::testing::AuthorityFolder authority_;
  dds::Participant participant_{palpate::testing::exclusiveDomain(), ending()};
  StatusPublisher status_{participant_, facts_};
  ParameterService parameters_{participant_, *channels_, facts_};
  RivalWatch rivals_{participant_, facts_, status_, 0.0};
  SecurityWatch security_{participant_};
  Events events_{*channels_, status_, parameters_, rivals_};
};

TEST_F(SecuredEvents, TheOwnEndIsToldWhateverStrangersBring) {
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  const std::string first = told(kSecond);
  EXPECT_TRUE(has(first, "in 0 days")) << first;
  EXPECT_TRUE(has(first, "DDS: ")) << first;
  const std::string second = told(kSecond + 1);
  EXPECT_FALSE(has(second, "in 0 days")) << second << "once a day";
  while (std::time(nullptr) < participant_.identity()->expires())
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(has(told(kSecond + 2), ": has expired, DDS has left the domain"));
  EXPECT_EQ(told(kSecond + 3), "") << "once, and strangers' lines once a second";
}

TEST(LinesInTurn, SomeWaitAndTheRestIsCounted) {
  LinesInTurn lines;
  EXPECT_TRUE(lines.empty());
  lines.add({"a", "b"});
  EXPECT_EQ(lines.next(), "a");
  lines.add(std::vector<std::string>(LinesInTurn::kMostWaiting + 1, "c"));
  EXPECT_EQ(lines.next(), "b (2 more left out)");
  for (std::size_t i = 1; i < LinesInTurn::kMostWaiting; ++i) EXPECT_EQ(lines.next(), "c");
  EXPECT_TRUE(lines.empty());
}

}  // namespace
}  // namespace palpate::server
