// SPDX-License-Identifier: Apache-2.0
// Who gets in, and how far, over DDS: a server and a tool with identities, and beside them one after the other those who should not
// get in, each a process of its own. Whatever they do, the tool is answered without a gap.
#include <csignal>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "intruder.h"
#include "palpate/testing/child_process.h"
#include "palpate/testing/timed_tests.h"
#include "secured_server.h"

namespace palpate::server::testing {
namespace {

constexpr const char* kNotLetIn = " shows no topic: it is not let in (no identity of this authority";
constexpr int kPatience = 60;  // s; lines are told one a second

// Somebody who should not get in.
class Intruder {
 public:
  explicit Intruder(std::vector<std::string> words)
      : process_(PALPATE_INTRUDER, std::move(words), {said_.descriptor(), -1}) {}

  [[nodiscard]] std::string said() const { return said_.text(); }
  // What names its participant and its endpoints, once it has joined.
  [[nodiscard]] std::optional<std::string> guid() {
    constexpr std::size_t kPrefix = 24;
    for (int i = 0; i < 50 * kPatience && process_.running(); ++i, pause(20)) {
      std::istringstream words(said());
      for (std::string word; words >> word;)
        if (word == "participant" && words >> word && word.size() > kPrefix) return word.substr(0, kPrefix);
    }
    return std::nullopt;
  }
  // Ends it. @return what it said, with the readers of each writer
  [[nodiscard]] std::string end() {
    process_.signal(SIGTERM);
    EXPECT_EQ(process_.waitForExit(std::chrono::seconds(kPatience)), 0) << said();
    return said();
  }

 private:
  palpate::testing::CaughtOutput said_;
  palpate::testing::ChildProcess process_;
};

[[nodiscard]] std::string property(const std::string& key, const fs::path& file) {
  return key + "=file:" + file.string();
}

// Takes the checks of its own side out (lenient_access_control.c), so that only the server's and the tool's are left.
[[nodiscard]] std::string lenient() {
  return std::string("dds.sec.access.library.path=") + PALPATE_LENIENT;
}

// The server and the tool, which all tests share, and who was there before them.
class Siege : public SecuredServer {
 public:
  void begin() {
    expireOne();
    if (HasFatalFailure()) return;
    ASSERT_NO_FATAL_FAILURE(startSecured({"--tools", "3"}));
  }

  void forget() { client_->forget(); }
  [[nodiscard]] Intruder& expired() { return *expired_; }
  [[nodiscard]] std::unique_ptr<Intruder> start(std::vector<std::string> words) const {
    words.insert(words.begin(), std::to_string(domain_));
    return std::make_unique<Intruder>(std::move(words));
  }
  [[nodiscard]] std::string log() const { return server_->log(); }
  [[nodiscard]] std::vector<std::string> onDomain(std::vector<std::string> words, const std::string& folder) {
    words.insert(words.end(), {"--domain", std::to_string(domain_), "--security", folder});
    return words;
  }
  [[nodiscard]] const AuthorityFolder& authority() const { return authority_; }
  [[nodiscard]] const AuthorityFolder& rogue() const { return rogue_; }

  // Whether the server logs a line with both.
  [[nodiscard]] bool logsOf(const std::string& guid, const std::string& text) const {
    for (int i = 0; i < 50 * kPatience; ++i, pause(20)) {
      std::istringstream lines(server_->log());
      for (std::string line; std::getline(lines, line);)
        if (line.find(guid) != std::string::npos && line.find(text) != std::string::npos) return true;
    }
    return false;
  }

  // What the tool got since forget(), a second's at least: each answer, all of its own server, with a force (but for what the tool
  // itself sent late, as the answer says); and nobody changed friction or moved tool 1.
  void expectUndisturbed() const {
    for (int i = 0; i < 500 && client_->forces().size() <= 1000; ++i) pause(20);
    const std::vector<dds::ToolForce> forces = client_->forces();
    ASSERT_GT(forces.size(), 1000U) << server_->log();
    EXPECT_EQ(gaps(forces), 0U);
    std::size_t late = 0;
    std::vector<dds::ToolForce> zero;
    for (const dds::ToolForce& force : forces) {
      if (force.session == palpate::testing::kIntrudersSession ||
          (force.flags & dds::flag::kTwoPublishers) != 0) {
        palpate::testing::countAlways();
        FAIL() << "an answer of session " << force.session << ", with flags " << force.flags;
      }
      if ((force.flags & (dds::flag::kStalePose | dds::flag::kRamping)) != 0)
        ++late;
      else if (sizeOf(force.force) == 0.0)
        zero.push_back(force);
    }
    EXPECT_TRUE(zero.empty()) << "of " << forces.size() << " answers, " << late
                              << " late; the first is number " << zero.front().seq << ", with flags "
                              << zero.front().flags;
    EXPECT_LT(10 * late, forces.size()) << server_->log();
    for (const char* const what : {"friction 0.01", "tool 1: first pose"}) {
      if (server_->log().find(what) == std::string::npos) continue;
      palpate::testing::countAlways();
      ADD_FAILURE() << what << "\n" << server_->log();
    }
  }

 private:
  void TestBody() override {}

  // Its permissions are good when it joins, and it stays although they end. Where the machine is busy it takes longer to join.
  void expireOne() {
    const fs::path folder = authority_.of("driver"), ending = folder / "ending.p7s";
    for (const int seconds : {3, 10, 40}) {
      const std::time_t end = std::time(nullptr) + seconds;
      writeEnding(folder, dds::Role::kDriver, end, ending);
      expired_ = start({folder.string(), property("dds.sec.access.permissions", ending), lenient()});
      if (!expired_->guid()) continue;
      while (std::time(nullptr) <= end) pause(20);
      return;
    }
    FAIL() << expired_->said();
  }

  const AuthorityFolder rogue_;
  std::unique_ptr<Intruder> expired_;
};

class SecurityMatrix : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    siege_ = std::make_unique<Siege>();
    siege_->begin();
  }
  static void TearDownTestSuite() { siege_.reset(); }

  void SetUp() override { siege_->forget(); }

  // One that makes writers, sends, and meets no reader. @param line  what the server says of it
  static void expectRefused(Intruder& intruder, const std::string& line,
                            const std::vector<std::string>& topics) {
    const std::optional<std::string> guid = intruder.guid();
    ASSERT_TRUE(guid.has_value()) << intruder.said();
    EXPECT_TRUE(siege_->logsOf(*guid, line)) << *guid << "\n" << siege_->log();
    const std::string said = intruder.end();
    for (const std::string& topic : topics) {
      EXPECT_NE(said.find(topic + ": writer made"), std::string::npos) << said;
      EXPECT_NE(said.find(topic + ": 0 readers"), std::string::npos) << said;
    }
  }
  static void expectRefused(const std::vector<std::string>& words, const std::string& line,
                            const std::vector<std::string>& topics) {
    expectRefused(*siege_->start(words), line, topics);
    siege_->expectUndisturbed();
  }
  [[nodiscard]] static std::string identityOf(const std::string& role) {
    return siege_->authority().of(role);
  }

  static std::unique_ptr<Siege> siege_;
};
std::unique_ptr<Siege> SecurityMatrix::siege_;

constexpr const char *kPoses = "palpate/tool/measured_cp", *kForces = "palpate/tool/servo_cf",
                     *kRequests = "palpate/server/parameter_request";

TEST_F(SecurityMatrix, RightRolesWork) {
  const auto run = [](const std::string& program, std::vector<std::string> words, const std::string& role) {
    const auto result = runProgram(program, siege_->onDomain(std::move(words), identityOf(role)));
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  run("palpate-list", {}, "viewer");
  run("palpate-watch", {"--seconds", "0.5"}, "viewer");
  run("palpate-parameters", {"--friction", "0.2"}, "operator");
  run("palpate-latency", {"--tool", "2", "--seconds", "1", "--assert", "received>100"}, "driver");
  run("palpate-tool", {"--tool", "2", "--seconds", "1"}, "driver");
  run("palpate-device", {"--tool", "2", "--motion", "press", "--seconds", "2"}, "driver");
  const palpate::testing::TemporaryFolder page;
  (void)page.write("index.html", "<!doctype html>");
  const palpate::testing::CaughtOutput said;
  const palpate::testing::ChildProcess viewer(
      "palpate-viewer",
      siege_->onDomain({"--port", "0", "--page", page.path().string()}, identityOf("viewer")),
      {said.descriptor(), said.descriptor()});
  for (int i = 0; i < 50 * kPatience && said.text().find("surface of model") == std::string::npos; ++i)
    pause(20);
  EXPECT_NE(said.text().find("surface of model"), std::string::npos) << said.text();
  siege_->expectUndisturbed();
}

TEST_F(SecurityMatrix, AClientSaysThatAServerIsThereThatItDoesNotMeet) {
  const auto refused =
      runProgram("palpate-tool", siege_->onDomain({"--wait", "2"}, siege_->rogue().of("driver")));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find(kNotLetIn), std::string::npos) << refused.err;
  siege_->expectUndisturbed();
}

TEST_F(SecurityMatrix, ExpiredPermissionsAreRefusedAndSaidSo) {
  expectRefused(siege_->expired(), kNotLetIn, {kPoses, kForces, kRequests});
  siege_->expectUndisturbed();
}

TEST_F(SecurityMatrix, AProgramWithoutAnIdentityIsRefusedAndNamed) {
  expectRefused({}, ", is not let in: it has no identity; start it with --security",
                {kPoses, kForces, kRequests});
  EXPECT_NE(siege_->log().find(", process security_intruder ("), std::string::npos) << siege_->log();
}

TEST_F(SecurityMatrix, AnotherAuthoritysDriverIsRefusedAndSaidSo) {
  expectRefused({siege_->rogue().of("driver")}, kNotLetIn, {kPoses});
}

TEST_F(SecurityMatrix, AnotherAuthoritysServerIsRefusedAndSaidSo) {
  expectRefused({siege_->rogue().of("server")}, kNotLetIn, {kForces});
}

// The certificate is good. What it may do it has signed itself, and believes it.
TEST_F(SecurityMatrix, ForgedPermissionsAreRefusedAndSaidSo) {
  const fs::path forged = siege_->rogue().of("driver");
  expectRefused(
      {identityOf("driver"), property("dds.sec.access.permissions_ca", forged / "permissions_authority.pem"),
       property("dds.sec.access.governance", forged / "governance.p7s"),
       property("dds.sec.access.permissions", forged / "permissions.p7s")},
      kNotLetIn, {kPoses});
}

// Its certificate is signed by the authority, and it signs with that: a chain that Cyclone DDS 0.10.2 follows (CVE-2023-24011).
TEST_F(SecurityMatrix, AViewerThatSignsItsOwnPermissionsIsRefusedAndSaidSo) {
  const fs::path folder = identityOf("viewer");
  const security::Signer itself{folder / "identity.pem", folder / "identity.key"};
  const std::string wanted = Siege::permissionsOf(folder, dds::Role::kOperator, std::time(nullptr) + 3600);
  security::writeSigned(itself, wanted, folder / "forged.p7s");
  security::writeSigned(itself, security::governance(), folder / "governance_forged.p7s");
  expectRefused({folder, property("dds.sec.access.governance", folder / "governance_forged.p7s"),
                 property("dds.sec.access.permissions", folder / "forged.p7s")},
                kNotLetIn, {kPoses, kRequests});
}

TEST_F(SecurityMatrix, AViewerThatWritesAllTheSameIsNotHeardAndSaidSo) {
  expectRefused({identityOf("viewer"), lenient()},
                "found a writer of palpate/tool/measured_cp that does not fit: type or permissions",
                {kPoses, kForces, kRequests});
}

// A driver may send poses of any tool, so this one sends none.
TEST_F(SecurityMatrix, ADriverThatForcesAndSetsParametersAllTheSameIsNotHeardAndSaidSo) {
  const std::string other = siege_->authority().issue(dds::Role::kDriver, "other", 365);
  const auto driver = siege_->start({other, lenient(), "no-poses"});
  const auto friction = [](std::vector<std::string> words) {
    const auto told =
        runProgram("palpate-parameters", siege_->onDomain(std::move(words), identityOf("operator")));
    EXPECT_NE(told.out.find("  friction            0.3, "), std::string::npos) << told.out << told.err;
  };
  friction({"--friction", "0.3"});
  expectRefused(*driver, "found a writer of palpate/server/parameter_request that does not fit",
                {kForces, kRequests});
  friction({});
  siege_->expectUndisturbed();
}

}  // namespace
}  // namespace palpate::server::testing
