// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palpate/idl/qos.h"
#include "palpate/idl/types.h"

namespace palpate::dds {

/// Name, type and QoS of the topic that carries T: the table of docs/design.md, Wire, and the only place where it is
/// written.
///   kName        the topic's name
///   kProfile     its QoS, on both ends
///   kFlat        true: T owns no memory, so it may be taken into the caller's buffer
///   descriptor() the generated type description
template <class T>
struct TopicTraits;

template <>
struct TopicTraits<ToolPose> {
  static constexpr const char* kName = "palpate/tool/measured_cp";
  static constexpr QosProfile kProfile = QosProfile::kServo;
  static constexpr bool kFlat = true;
  static const dds_topic_descriptor_t& descriptor() noexcept { return palpate_ToolPose_desc; }
};

template <>
struct TopicTraits<ToolForce> {
  static constexpr const char* kName = "palpate/tool/servo_cf";
  static constexpr QosProfile kProfile = QosProfile::kServo;
  static constexpr bool kFlat = true;
  static const dds_topic_descriptor_t& descriptor() noexcept { return palpate_ToolForce_desc; }
};

template <>
struct TopicTraits<SurfaceDisplacement> {
  static constexpr const char* kName = "palpate/organ/displacement";
  static constexpr QosProfile kProfile = QosProfile::kField;
  static constexpr bool kFlat = false;
  static const dds_topic_descriptor_t& descriptor() noexcept { return palpate_SurfaceDisplacement_desc; }
};

template <>
struct TopicTraits<SurfaceMesh> {
  static constexpr const char* kName = "palpate/organ/surface";
  static constexpr QosProfile kProfile = QosProfile::kLatched;
  static constexpr bool kFlat = false;
  static const dds_topic_descriptor_t& descriptor() noexcept { return palpate_SurfaceMesh_desc; }
};

template <>
struct TopicTraits<ServerStatus> {
  static constexpr const char* kName = "palpate/server/status";
  static constexpr QosProfile kProfile = QosProfile::kLatched;
  static constexpr bool kFlat = true;
  static const dds_topic_descriptor_t& descriptor() noexcept { return palpate_ServerStatus_desc; }
};

template <>
struct TopicTraits<ParameterRequest> {
  static constexpr const char* kName = "palpate/server/parameter_request";
  static constexpr QosProfile kProfile = QosProfile::kRequest;
  static constexpr bool kFlat = true;
  static const dds_topic_descriptor_t& descriptor() noexcept { return palpate_ParameterRequest_desc; }
};

template <>
struct TopicTraits<ToolAnnouncement> {
  static constexpr const char* kName = "palpate/tool/announcement";
  static constexpr QosProfile kProfile = QosProfile::kRequest;
  static constexpr bool kFlat = true;
  static const dds_topic_descriptor_t& descriptor() noexcept { return palpate_ToolAnnouncement_desc; }
};

template <>
struct TopicTraits<ServerParameters> {
  static constexpr const char* kName = "palpate/server/parameters";
  static constexpr QosProfile kProfile = QosProfile::kAnswer;
  static constexpr bool kFlat = true;
  static const dds_topic_descriptor_t& descriptor() noexcept { return palpate_ServerParameters_desc; }
};

}  // namespace palpate::dds
