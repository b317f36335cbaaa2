// SPDX-License-Identifier: Apache-2.0
// Who should not get in, as a process: joins a domain and writes poses of tools 0 and 1, forces of a session of its own, and
// requests for another friction, 200 a second, until SIGTERM. Says its participant and which writers it has, and at its end how many
// readers each matched.
//   security_intruder DOMAIN [FOLDER [PROPERTY=VALUE... | no-poses]]
// With FOLDER, an identity, whose properties may be replaced one by one, without the checks of dds::Identity. Its own side takes
// permissions and governance of whoever signed them.
#include "intruder.h"

#include <dlfcn.h>
#include <openssl/pkcs7.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "palpate/idl/entity.h"
#include "palpate/idl/error.h"
#include "palpate/idl/identity.h"
#include "palpate/idl/raw.h"
#include "palpate/idl/topics.h"

// Exported, so that the plugins call it: whether the signer may sign is not asked.
extern "C" int PKCS7_verify(PKCS7* message, STACK_OF(X509) * certificates, X509_STORE* store, BIO* content,
                            BIO* out, int flags) {
  static const auto verify = reinterpret_cast<decltype(&PKCS7_verify)>(dlsym(RTLD_NEXT, "PKCS7_verify"));
  return verify(message, certificates, store, content, out, flags | PKCS7_NOVERIFY);
}

namespace palpate::dds {
namespace {

volatile std::sig_atomic_t stop = 0;

template <class T>
class Intruding {
 public:
  explicit Intruding(const Entity& participant) {
    using Traits = TopicTraits<T>;
    const dds_entity_t topic = raw::createTopic(participant.handle(), Traits::descriptor(), Traits::kName);
    try {
      writer_ = Entity(raw::createWriter(participant.handle(), topic, Traits::kName, Traits::kProfile));
      std::cout << Traits::kName << ": writer made" << std::endl;
    } catch (const DdsError& error) {
      std::cout << error.what() << std::endl;
    }
  }
  void write(const T& sample) {
    if (writer_.handle() <= 0) return;
    matched_ = std::max(matched_, raw::matchedReaders(writer_.handle()));
    (void)dds_write(writer_.handle(), &sample);
  }
  void tell() const { std::cout << TopicTraits<T>::kName << ": " << matched_ << " readers\n"; }

 private:
  Entity writer_;
  unsigned matched_{0};
};

Entity join(const std::vector<std::string>& words) {
  const QosPtr qos(dds_create_qos());
  if (words.size() > 1) Identity::load(words[1]).applyTo(*qos);
  char* plugin = nullptr;  // for lenient_access_control.c
  if (dds_qget_prop(qos.get(), "dds.sec.access.library.path", &plugin))
    setenv("PALPATE_ACCESS_CONTROL", plugin, 1);
  dds_free(plugin);
  for (std::size_t i = 2; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    if (equals == std::string::npos) continue;
    dds_qset_prop(qos.get(), words[i].substr(0, equals).c_str(), words[i].substr(equals + 1).c_str());
  }
  const auto domain = static_cast<dds_domainid_t>(std::stoul(words[0]));
  return Entity(checked(dds_create_participant(domain, qos.get(), nullptr), "cannot join"));
}

ToolPose poseOf(std::uint32_t tool, std::uint64_t seq) {
  ToolPose pose{};
  pose.server_id = kServerAny;
  pose.tool_id = tool;
  pose.seq = seq;
  pose.position[0] = 1.0;
  pose.orientation[3] = 1.0;
  return pose;
}

int run(const std::vector<std::string>& words) {
  std::signal(SIGTERM, [](int) { stop = 1; });
  const Entity participant = join(words);
  dds_guid_t guid{};
  (void)dds_get_guid(participant.handle(), &guid);
  std::cout << "participant " << raw::textOf(guid) << std::endl;
  const bool with_poses = std::find(words.begin(), words.end(), "no-poses") == words.end();
  std::optional<Intruding<ToolPose>> poses;
  if (with_poses) poses.emplace(participant);
  Intruding<ToolForce> forces(participant);
  Intruding<ParameterRequest> requests(participant);
  ToolForce force{};
  force.session = testing::kIntrudersSession;
  ParameterRequest request{};
  request.request_id = testing::kIntrudersSession;
  request.tool_id = kAllTools;
  request.fields = parameter::kFriction;
  request.friction = testing::kIntrudersFriction;
  for (std::uint64_t seq = 1; stop == 0; ++seq) {
    if (poses)
      for (const std::uint32_t tool : {0U, 1U}) poses->write(poseOf(tool, seq));
    force.seq = seq;
    forces.write(force);
    if (seq % 20 == 0) requests.write(request);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (poses) poses->tell();
  forces.tell();
  requests.tell();
  return 0;
}

}  // namespace
}  // namespace palpate::dds

int main(int argc, char** argv) {
  try {
    return palpate::dds::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cout << error.what() << "\n";
    return 1;
  }
}
