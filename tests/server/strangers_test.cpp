// SPDX-License-Identifier: Apache-2.0
// Programs of others, made from the IDL with another DDS or without a thought of QoS.
#include "server_fixture.h"

namespace palpate::server::testing {
namespace {

class Strangers : public ServerEndToEnd {
 protected:
  // A reader, or a writer, that somebody made without ours. @param[in] qos  null: DDS's defaults
  template <class T>
  [[nodiscard]] dds::Entity reader(const dds_qos_t* qos = nullptr) {
    return dds::Entity(dds_create_reader(participant_.handle(), topic<T>(), qos, nullptr));
  }
  template <class T>
  [[nodiscard]] dds::Entity writer(const dds_qos_t* qos = nullptr) {
    return dds::Entity(dds_create_writer(participant_.handle(), topic<T>(), qos, nullptr));
  }

 private:
  template <class T>
  [[nodiscard]] dds_entity_t topic() {
    return dds_create_topic(participant_.handle(), &dds::TopicTraits<T>::descriptor(),
                            dds::TopicTraits<T>::kName, nullptr, nullptr);
  }

  dds::Participant participant_{palpate::testing::exclusiveDomain()};
};

TEST_F(Strangers, AWriterThatDoesNotMatchIsLoggedWithItsPoliciesAndItsProcess) {
  ASSERT_NO_FATAL_FAILURE(start());
  const dds::QosPtr qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_ownership(qos.get(), DDS_OWNERSHIP_EXCLUSIVE);
  const dds::Entity requests = writer<dds::ParameterRequest>(qos.get());
  EXPECT_TRUE(logs(
      "found a writer of palpate/server/parameter_request that does not fit: reliability, ownership; it is "))
      << server_->log();
  EXPECT_TRUE(logs("process server_e2e_test (" + std::to_string(getpid()) + ") on ")) << server_->log();
}

TEST_F(Strangers, AFloodOfEndpointsThatDoNotMatchIsLoggedOnceASecond) {
  ASSERT_NO_FATAL_FAILURE(start());
  const dds::QosPtr qos(dds_create_qos());
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  std::vector<dds::Entity> flood;
  for (int i = 0; i < 100; ++i) flood.push_back(reader<dds::ToolForce>(qos.get()));
  ASSERT_TRUE(logs("does not fit: durability")) << server_->log();
  pause(700);
  const std::string log = server_->log();
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = log.find("does not fit", at)) != std::string::npos; ++at) ++lines;
  EXPECT_LE(lines, 8U) << log;
}

TEST_F(Strangers, AReaderOfDefaultQosThatComesLateGetsTheSurface) {
  ASSERT_NO_FATAL_FAILURE(start());
  const dds::Entity late = reader<dds::SurfaceMesh>();
  std::size_t nodes = 0;
  for (int i = 0; i < 250 && nodes == 0; ++i, pause(20)) {
    const dds::LoanedSamples<dds::SurfaceMesh> samples(late.handle());
    if (!samples.empty()) nodes = samples[0].positions._length / 3;
  }
  EXPECT_EQ(nodes, target_.nodes);
}

TEST_F(Strangers, TheSurfaceSaysWhatIsHeldAndWhatIsInside) {
  palpate::testing::writeSyntheticModel(model_, {.nodule_above = 0.8});
  ASSERT_NO_FATAL_FAILURE(start());
  const auto data = palpate::testing::syntheticModel({.nodule_above = 0.8});
  const dds::Entity late = reader<dds::SurfaceMesh>();
  bool came = false;
  for (int i = 0; i < 250 && !came; ++i, pause(20)) {
    const dds::LoanedSamples<dds::SurfaceMesh> samples(late.handle());
    if (samples.empty()) continue;
    came = true;
    const dds::SurfaceMesh& mesh = samples[0];
    ASSERT_EQ(mesh.clamped._length, target_.nodes);
    for (std::uint32_t node = 0; node < mesh.clamped._length; ++node)
      EXPECT_EQ(mesh.clamped._buffer[node] == 1, data.position_of_node[node] < 0) << node;
    ASSERT_EQ(mesh.regions._length, 2U);
    const dds::Region &around = mesh.regions._buffer[0], &nodule = mesh.regions._buffer[1];
    EXPECT_STREQ(around.name, "elsewhere");
    EXPECT_EQ(around.triangles._length, 0U);
    EXPECT_STREQ(nodule.name, "nodule");
    EXPECT_EQ(nodule.youngs_modulus, 10.0 * data.attributes.E);
    // A cone with its tip in the centre: a triangle for each edge of its rim, where all but one of its nodes are.
    EXPECT_GT(nodule.triangles._length / 3, 20U);
    EXPECT_EQ(nodule.positions._length, nodule.triangles._length + 3);
    EXPECT_EQ(mesh.contact_radius, data.attributes.patch_radius);
    EXPECT_STREQ(mesh.certificate,
                 "not certified: the model file does not state how far its answers are off");
  }
  EXPECT_TRUE(came);
}

}  // namespace
}  // namespace palpate::server::testing
