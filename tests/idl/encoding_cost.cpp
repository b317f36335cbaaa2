// SPDX-License-Identifier: Apache-2.0
// What @appendable costs on the 1 kHz types: the same fields once @appendable and once @final, in turn, in one run.
// A pose goes to another process, which answers with a force. docs/decisions/appendable.md
#include <final.h>  // palpate.idl with all types @final
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "palpate/idl/entity.h"
#include "palpate/idl/participant.h"
#include "palpate/idl/qos.h"
#include "palpate/idl/types.h"
#include "palpate/testing/child_process.h"
#include "palpate/testing/test_domain.h"

namespace palpate::dds {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

double quantile(std::vector<double> values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// One end of a pair of topics, poses one way and forces the other.
template <class Out, class In>
class End {
 public:
  End(const Participant& participant, const std::string& name, const dds_topic_descriptor_t& out_type,
      const dds_topic_descriptor_t& in_type, const char* out, const char* in, bool answers)
      : answers_(answers),
        out_(dds_create_topic(participant.handle(), &out_type, (name + out).c_str(), nullptr, nullptr)),
        in_(dds_create_topic(participant.handle(), &in_type, (name + in).c_str(), nullptr, nullptr)),
        writer_(dds_create_writer(participant.handle(), out_.handle(),
                                  makeQos(QosProfile::kServo, Endpoint::kWriter).get(), nullptr)) {
    dds_listener_t* listener = dds_create_listener(this);
    dds_lset_data_available(listener, &End::onData);
    reader_ = Entity(dds_create_reader(participant.handle(), in_.handle(),
                                       makeQos(QosProfile::kServo, Endpoint::kReader).get(), listener));
    dds_delete_listener(listener);
  }

  void measure(std::uint64_t seq) {
    sample_.seq = seq;
    const Clock::time_point start = Clock::now();
    (void)dds_write(writer_.handle(), &sample_);
    write_us_.push_back(microseconds(Clock::now() - start));
    std::this_thread::sleep_for(700us);
    if (answered_ == seq) round_us_.push_back(microseconds(received_ - start));
  }

  void print(const char* name) const {
    std::printf("%-12s write p50 %5.1f us, round trip p50 %5.1f p90 %5.1f us, %zu of %zu answered\n", name,
                quantile(write_us_, 0.5), quantile(round_us_, 0.5), quantile(round_us_, 0.9),
                round_us_.size(), write_us_.size());
  }

 private:
  static void onData(dds_entity_t reader, void* arg) {
    auto& self = *static_cast<End*>(arg);
    In got{};
    void* buffer = &got;
    dds_sample_info_t info{};
    if (dds_take(reader, &buffer, &info, 1, 1) != 1) return;
    if (self.answers_) {
      self.sample_.seq = got.seq;
      (void)dds_write(self.writer_.handle(), &self.sample_);
    }
    self.received_ = Clock::now();
    self.answered_ = got.seq;
  }

  bool answers_;
  Entity out_, in_, writer_;
  Out sample_{};
  std::vector<double> write_us_, round_us_;
  Clock::time_point received_;
  std::atomic<std::uint64_t> answered_{0};
  Entity reader_;  // last: its callback uses the rest
};

void answer(const Participant& participant) {
  const End<ToolForce, ToolPose> appendable(participant, "appendable", palpate_ToolForce_desc,
                                            palpate_ToolPose_desc, "/force", "/pose", true);
  const End<final_ToolForce, final_ToolPose> final(participant, "final", final_ToolForce_desc,
                                                   final_ToolPose_desc, "/force", "/pose", true);
  pause();  // until the other process ends this one
}

void ask(const Participant& participant) {
  End<ToolPose, ToolForce> appendable(participant, "appendable", palpate_ToolPose_desc,
                                      palpate_ToolForce_desc, "/pose", "/force", false);
  End<final_ToolPose, final_ToolForce> final(participant, "final", final_ToolPose_desc, final_ToolForce_desc,
                                             "/pose", "/force", false);
  std::this_thread::sleep_for(1s);
  for (std::uint64_t seq = 1; seq <= 5000; ++seq) {
    final.measure(seq);
    appendable.measure(seq);
  }
  final.print("final");
  appendable.print("appendable");
}

}  // namespace
}  // namespace palpate::dds

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc == 2) {
    dds::answer(dds::Participant(static_cast<std::uint32_t>(std::stoul(argv[1]))));
    return 0;
  }
  const std::uint32_t domain = testing::exclusiveDomain();
  const testing::ChildProcess other(argv[0], {std::to_string(domain)}, {});
  dds::ask(dds::Participant(domain));
  return 0;
}
