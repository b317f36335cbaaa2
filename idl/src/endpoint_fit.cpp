// SPDX-License-Identifier: Apache-2.0
#include "palpate/idl/endpoint_fit.h"

#include <algorithm>
#include <vector>

namespace palpate::dds {
namespace {

// What a policy says; its default when the other DDS did not send it.
template <class T>
T valueOf(bool (*get)(const dds_qos_t*, T*), const dds_qos_t* qos, T otherwise) {
  T value = otherwise;
  return get(qos, &value) ? value : otherwise;
}

template <class T>
T reliabilityOf(const dds_qos_t* qos, T otherwise) {
  dds_duration_t blocking = 0;
  T kind = otherwise;
  return dds_qget_reliability(qos, &kind, &blocking) ? kind : otherwise;
}

struct Presentation {
  explicit Presentation(const dds_qos_t* qos) {
    (void)dds_qget_presentation(qos, &scope, &coherent, &ordered);
  }
  dds_presentation_access_scope_kind_t scope{DDS_PRESENTATION_INSTANCE};
  bool coherent{false};
  bool ordered{false};
};

struct Liveliness {
  explicit Liveliness(const dds_qos_t* qos) { (void)dds_qget_liveliness(qos, &kind, &lease); }
  dds_liveliness_kind_t kind{DDS_LIVELINESS_AUTOMATIC};
  dds_duration_t lease{DDS_INFINITY};
};

bool presentationFits(const dds_qos_t* writer, const dds_qos_t* reader) {
  const Presentation offered(writer), wanted(reader);
  return offered.scope >= wanted.scope && offered.coherent >= wanted.coherent &&
         offered.ordered >= wanted.ordered;
}

bool livelinessFits(const dds_qos_t* writer, const dds_qos_t* reader) {
  const Liveliness offered(writer), wanted(reader);
  return offered.kind >= wanted.kind && offered.lease <= wanted.lease;
}

std::vector<dds_data_representation_id_t> representations(const dds_qos_t* qos) {
  std::uint32_t count = 0;
  dds_data_representation_id_t* values = nullptr;
  if (!dds_qget_data_representation(qos, &count, &values) || count == 0)
    return {DDS_DATA_REPRESENTATION_XCDR1};
  const std::vector<dds_data_representation_id_t> list(values, values + count);
  dds_free(values);
  return list;
}

bool representationFits(const dds_qos_t* writer, const dds_qos_t* reader) {
  const auto wanted = representations(reader);
  return std::find(wanted.begin(), wanted.end(), representations(writer).front()) != wanted.end();
}

// Ours are in no partition.
bool inAPartition(const dds_qos_t* qos) {
  std::uint32_t count = 0;
  char** names = nullptr;
  if (!dds_qget_partition(qos, &count, &names)) return false;
  bool named = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    named = named || names[i][0] != '\0';
    dds_free(names[i]);
  }
  dds_free(names);
  return named;
}

}  // namespace

std::string policiesInTheWay(const dds_qos_t* writer, const dds_qos_t* reader) {
  std::string list;
  const auto expect = [&list](const char* policy, bool fits) {
    if (!fits) list += (list.empty() ? "" : ", ") + std::string(policy);
  };
  const auto offers = [&](auto get, auto otherwise) {
    return valueOf(get, writer, otherwise) >= valueOf(get, reader, otherwise);
  };
  const auto keeps = [&](auto get, auto otherwise) {
    return valueOf(get, writer, otherwise) <= valueOf(get, reader, otherwise);
  };
  expect("reliability", reliabilityOf(writer, DDS_RELIABILITY_RELIABLE) >=
                            reliabilityOf(reader, DDS_RELIABILITY_BEST_EFFORT));
  expect("durability", offers(&dds_qget_durability, DDS_DURABILITY_VOLATILE));
  expect("deadline", keeps(&dds_qget_deadline, DDS_INFINITY));
  expect("liveliness", livelinessFits(writer, reader));
  expect("latency budget", keeps(&dds_qget_latency_budget, dds_duration_t{0}));
  expect("destination order",
         offers(&dds_qget_destination_order, DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP));
  expect("ownership", valueOf(&dds_qget_ownership, writer, DDS_OWNERSHIP_SHARED) ==
                          valueOf(&dds_qget_ownership, reader, DDS_OWNERSHIP_SHARED));
  expect("presentation", presentationFits(writer, reader));
  expect("data representation", representationFits(writer, reader));
  expect("partition", inAPartition(writer) == inAPartition(reader));
  return list;
}

}  // namespace palpate::dds
