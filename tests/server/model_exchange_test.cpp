// SPDX-License-Identifier: Apache-2.0
// The steps of an exchange; the test plays the tick and the surface's thread.
#include "palpate/server/model_exchange.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"

namespace palpate::server {
namespace {

constexpr std::int64_t kOneSecond = 1'000'000'000;

std::shared_ptr<const MetaModel> loaded(const std::filesystem::path& path) {
  return std::shared_ptr<const MetaModel>(new const MetaModel(MetaModel::load(path)));
}

class ModelExchangeTest : public ::testing::Test {
 protected:
  ModelExchangeTest() {
    palpate::testing::writeSyntheticModel(folder_ / "next.h5", {.subdivisions = 2, .stiffness = 600.0});
    std::filesystem::copy_file(first_file_.path(), folder_ / "same.h5");
    (void)folder_.write("broken.h5", "no model");
    auto first = loaded(first_file_.path());
    first_ = first;
    exchange_.emplace(*channels_, Served{facts_, book_, surface_, nullptr},
                      std::make_unique<Engine>(std::move(first), facts_.step),
                      std::make_unique<ModelLoader>(folder_.path()));
  }

  // Polls until the request has ended, or the tick is to go over; for a minute: a process is started under sanitizers, too.
  std::optional<ExchangeOutcome> settle() {
    for (int i = 0; i < 12'000 && !exchange_->leaving(); ++i) {
      if (auto outcome = exchange_->poll(now_ns_)) return outcome;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return std::nullopt;
  }
  [[nodiscard]] bool freed() const {
    for (int i = 0; i < 4000 && !first_.expired(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return first_.expired();
  }

  static ServerConfig config() {
    ServerConfig config;
    config.device = "custom";
    settleTools(config);
    return config;
  }
  static std::filesystem::path written(const std::filesystem::path& path) {
    palpate::testing::writeSyntheticModel(path);
    return path;
  }

  palpate::testing::TemporaryFolder folder_;
  palpate::testing::TemporaryFile first_file_{"exchange.h5"};
  std::unique_ptr<Channels> channels_ = std::make_unique<Channels>();
  std::shared_ptr<const MetaModel> shape_of_ = loaded(written(first_file_.path()));
  Facts facts_ = factsOf(*shape_of_, config());
  ParameterBook book_{facts_};
  dds::Participant participant_{palpate::testing::exclusiveDomain()};
  RestSurface surface_{participant_, facts_, std::make_unique<const OrganShape>(*shape_of_)};
  std::weak_ptr<const MetaModel> first_;
  std::optional<ModelExchange> exchange_;
  std::int64_t now_ns_{10 * kOneSecond};
};

TEST_F(ModelExchangeTest, GoesThroughItsStepsAndFreesTheModelBeforeOnceNobodyLooks) {
  const std::string before = facts_.model_id;
  ASSERT_EQ(exchange_->ask("next.h5", 42, now_ns_), "");
  EXPECT_TRUE(exchange_->pending(42));
  EXPECT_FALSE(exchange_->pending(43));
  EXPECT_NE(exchange_->ask("same.h5", 43, now_ns_).find("another model is on its way: \"next.h5\""),
            std::string::npos);
  EXPECT_FALSE(settle());
  ASSERT_TRUE(exchange_->leaving());
  Engine* const offered = channels_->next_engine.load();
  ASSERT_NE(offered, nullptr);
  EXPECT_EQ(offered->number, 1U);
  EXPECT_FALSE(exchange_->poll(now_ns_)) << "the tick has not gone over yet";
  EXPECT_EQ(facts_.model_id, before);
  channels_->engine_in_use = 1;  // the tick
  const auto outcome = exchange_->poll(now_ns_);
  ASSERT_TRUE(outcome.has_value());
  EXPECT_EQ(outcome->request_id, 42U);
  EXPECT_EQ(outcome->refusal, "");
  EXPECT_EQ(outcome->line.find("another organ: model next.h5: driven by displacement, 162 surface nodes"),
            0U);
  EXPECT_EQ(facts_.model_id, offered->id);
  EXPECT_NE(facts_.model_id, before);
  EXPECT_EQ(channels_->engine_to_show, 1U);
  EXPECT_TRUE(channels_->surface_ready.tryWait()) << "the surface's thread is woken";
  EXPECT_FALSE(exchange_->poll(now_ns_));
  EXPECT_FALSE(first_.expired()) << "the surface's thread may look at it";
  channels_->engine_shown = 1;  // that thread
  EXPECT_FALSE(exchange_->poll(now_ns_));
  EXPECT_TRUE(freed());
  EXPECT_EQ(exchange_->ask("same.h5", 44, now_ns_ + kOneSecond / 2),
            "a model was looked at a moment ago, the next one may be asked for in 0.5 s");
  EXPECT_EQ(exchange_->ask("same.h5", 45, now_ns_ + 2 * kOneSecond), "");
}

TEST_F(ModelExchangeTest, RestsAsLongAsALookTookAlsoWhereItWasRefused) {
  for (const char* name : {"broken.h5", "same.h5"}) {
    ASSERT_EQ(exchange_->ask(name, 7, now_ns_), "");
    now_ns_ += 3 * kOneSecond;  // by the clock that the exchange is told
    ASSERT_TRUE(settle().has_value());
    EXPECT_EQ(exchange_->ask("next.h5", 8, now_ns_ + 1),
              "a model was looked at a moment ago, the next one may be asked for in 3.0 s");
    now_ns_ += 3 * kOneSecond;
  }
  ASSERT_EQ(exchange_->ask("broken.h5", 9, now_ns_), "");
  ASSERT_TRUE(settle().has_value()) << "at once, by that clock";
  EXPECT_NE(exchange_->ask("next.h5", 10, now_ns_ + kOneSecond - 1), "");
  EXPECT_EQ(exchange_->ask("next.h5", 11, now_ns_ + kOneSecond), "");
}

TEST_F(ModelExchangeTest, SaysWhetherTheModelInUseIsLockedWhateverTheOneBeforeWas) {
  facts_.process_locked = true;
  facts_.memory_locked = false;  // the first could not be
  ASSERT_EQ(exchange_->ask("next.h5", 42, now_ns_), "");
  EXPECT_FALSE(settle());
  channels_->engine_in_use = 1;
  ASSERT_TRUE(exchange_->poll(now_ns_).has_value());
  const Engine* const taken = channels_->next_engine.load();
  if (!taken->model->locked()) GTEST_SKIP() << "no memory may be locked here";
  EXPECT_TRUE(facts_.memory_locked);
}

TEST_F(ModelExchangeTest, ALockedModelIsNotAllWhereTheProcessIsNotLocked) {
  facts_.process_locked = false;
  ASSERT_EQ(exchange_->ask("next.h5", 42, now_ns_), "");
  EXPECT_FALSE(settle());
  channels_->engine_in_use = 1;
  ASSERT_TRUE(exchange_->poll(now_ns_).has_value());
  EXPECT_FALSE(facts_.memory_locked);
}

TEST_F(ModelExchangeTest, ARefusedModelChangesNothing) {
  const std::string before = facts_.model_id;
  for (const char* name : {"broken.h5", "none.h5"}) {
    ASSERT_EQ(exchange_->ask(name, 7, now_ns_), "");
    const auto outcome = settle();
    ASSERT_TRUE(outcome.has_value());
    EXPECT_NE(outcome->refusal.find(name), std::string::npos) << outcome->refusal;
    EXPECT_FALSE(exchange_->pending(7));
    now_ns_ += 10 * kOneSecond;
  }
  EXPECT_EQ(channels_->next_engine.load(), nullptr);
  EXPECT_EQ(facts_.model_id, before);
  EXPECT_EQ(book_.revision(), 0U);
  EXPECT_FALSE(first_.expired());
}

TEST_F(ModelExchangeTest, TheModelInUseIsThereAlready) {
  ASSERT_EQ(exchange_->ask("same.h5", 7, now_ns_), "");
  const auto outcome = settle();
  ASSERT_TRUE(outcome.has_value());
  EXPECT_EQ(outcome->refusal, "");
  EXPECT_EQ(outcome->line, "");
  EXPECT_EQ(channels_->next_engine.load(), nullptr);
}

TEST_F(ModelExchangeTest, TheNextEngineBeginsWithWhatIsInForce) {
  dds::ParameterRequest asked{};
  asked.request_id = 1;
  asked.tool_id = 2;
  asked.fields = dds::parameter::kFriction | dds::parameter::kYoungsModulus;
  asked.friction = 0.05;
  asked.youngs_modulus = 5e4;
  ASSERT_TRUE(book_.decide(asked).accepted);
  ASSERT_EQ(exchange_->ask("next.h5", 42, now_ns_), "");
  EXPECT_FALSE(settle());
  const Engine* const offered = channels_->next_engine.load();
  ASSERT_NE(offered, nullptr);
  EXPECT_EQ(offered->work.live(2).friction, 0.05);
  EXPECT_EQ(offered->work.live(0).friction, 0.3);
  EXPECT_EQ(offered->work.live(0).youngs_modulus, offered->organ.attributes().E) << "the organ's own";
}

TEST_F(ModelExchangeTest, AnOfferThatTheTickNeverTakesIsFreedAtTheEnd) {
  ASSERT_EQ(exchange_->ask("next.h5", 42, now_ns_), "");
  EXPECT_FALSE(settle());
  const std::weak_ptr<const MetaModel> next = channels_->next_engine.load()->model;
  exchange_.reset();
  EXPECT_TRUE(next.expired());
  EXPECT_TRUE(first_.expired());
}

/// A program in the place of palpate-read-model.
std::filesystem::path script(const palpate::testing::TemporaryFolder& folder, const std::string& text) {
  const auto path = folder.write("reader", "#!/bin/sh\n" + text + "\n");
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

TEST_F(ModelExchangeTest, AProcessThatIsKilledOrLiesIsARefusal) {
  const std::pair<const char*, const char*> ends[]{
      {"kill -SYS $$",
       "next.h5: the process that parses it ended by Bad system call, the file is damaged or made to harm"},
      {"echo liver",
       "next.h5: the answer of the process that parses it is not to be believed: it is not that of this "
       "version of "
       "palpate-read-model"}};
  for (const auto& [text, refusal] : ends) {
    ModelLoader loader(folder_.path(), script(folder_, text));
    loader.load("next.h5");
    std::optional<LoadedModel> model;
    for (int i = 0; i < 4000 && !model; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(5)))
      model = loader.poll();
    ASSERT_TRUE(model.has_value());
    EXPECT_EQ(model->model, nullptr);
    EXPECT_EQ(model->refusal, refusal);
  }
}

TEST_F(ModelExchangeTest, AProcessThatHangsDoesNotKeepTheLoaderFromEnding) {
  const auto begun = folder_ / "begun";
  auto loader = std::make_unique<ModelLoader>(
      folder_.path(), script(folder_, "echo >" + begun.string() + "\nexec /bin/sleep 600"));
  loader->load("next.h5");
  for (int i = 0; i < 4000 && !std::filesystem::exists(begun); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(std::filesystem::exists(begun));
  const auto before = std::chrono::steady_clock::now();
  loader.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(5)) << "it is waited for 30 s";
}

}  // namespace
}  // namespace palpate::server
