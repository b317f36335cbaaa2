// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <initializer_list>

#include "tools/solver/build/case_file.h"

namespace palpate::solver {

namespace {

constexpr std::array<Method, 5> kMethods{Method::kSeriesDisplacement, Method::kSeriesForce,
                                         Method::kPgdLinear, Method::kPgdExplicit, Method::kPgdEuler};

constexpr unsigned bit(Method method) {
  return 1U << static_cast<unsigned>(method);
}
constexpr unsigned kSeries = bit(Method::kSeriesDisplacement) | bit(Method::kSeriesForce);
constexpr unsigned kStepped = bit(Method::kPgdExplicit) | bit(Method::kPgdEuler);
constexpr unsigned kPgd = bit(Method::kPgdLinear) | kStepped;

/// A key that only some methods use.
struct Rule {
  const char* key;
  bool given;
  unsigned methods;  ///< bits
  const char* reason;
};

void check(const Case& c, const Rule& rule) {
  if (!rule.given || (rule.methods & bit(c.method)) != 0) return;
  std::string list;
  for (const Method method : kMethods)
    if ((rule.methods & bit(method)) != 0) list += (list.empty() ? "" : ", ") + toString(method);
  throw CaseError(std::string(rule.key) + " has no effect with method " + toString(c.method) + ": " +
                  rule.reason + " (it is for " + list + ")");
}

void checkKeys(const Case& c) {
  constexpr unsigned kDisplacement = bit(Method::kSeriesDisplacement), kLinear = bit(Method::kPgdLinear);
  const char* const any_load = "a series holds every load of its domain";
  const char* const no_pairs = "it enriches no pairs";
  const bool direction = c.load.direction || c.load.any_direction;
  for (const Rule& rule : std::initializer_list<Rule>{
           {"model.order", c.order.has_value(), kSeries, "it is the degree of a series"},
           {"model.force_order", c.force_order.has_value(), kDisplacement,
            "its answer has the degree of its fields"},
           {"target.travel", c.travel.has_value(), kDisplacement, "it is of the series in d"},
           {"mesh.error", c.mesh_error, kDisplacement, "it is of the series in d"},
           {"model.near_radius", c.near_radius.has_value(), kDisplacement, "its model is modes only"},
           {"target.force_error", c.force_error.has_value(), kDisplacement, "it is of the series in d"},
           {"target.field_error", c.field_error.has_value(), kDisplacement,
            "its modes are as many as model.modes"},
           {"target.machine", c.handheld(), kDisplacement, "its size is that of its modes"},
           {"target.size_limit", c.size_limit.has_value(), kDisplacement, "its size is that of its modes"},
           {"model.sweeps", c.sweeps.has_value(), kSeries,
            "it fits no table of fields; pgd.sweeps sets the sweeps of a pair"},
           {"load.direction", direction, kPgd, any_load},
           {"load.magnitude", c.load.magnitude.has_value(), kPgd, any_load},
           {"load.kind", c.load.node.has_value(), kPgd, "a series belongs to a contact patch"},
           {"load.steps", c.load.steps.has_value(), kStepped, "it takes no load steps"},
           {"load.truncation", c.load.truncation.has_value(), kLinear, "it does not truncate the load"},
           {"pgd.separation", c.pgd.hadamard.has_value(), kLinear, "it has scalar pairs or none"},
           {"pgd.tolerance", c.pgd.tolerance.has_value(), kPgd, no_pairs},
           {"pgd.greedy_pairs", c.pgd.greedy_pairs.has_value(), kPgd, no_pairs},
           {"pgd.sweeps", c.pgd.sweeps.has_value(), kPgd, no_pairs},
           {"pgd.update", c.pgd.update.has_value(), kLinear, "it has no such update"},
           {"pgd.block", c.pgd.block.has_value(), kLinear, "it finds pairs one at a time or none"}})
    check(c, rule);
}

}  // namespace

std::string toString(Method method) {
  switch (method) {
    case Method::kSeriesDisplacement:
      return "series-displacement";
    case Method::kSeriesForce:
      return "series-force";
    case Method::kPgdLinear:
      return "pgd-linear";
    case Method::kPgdExplicit:
      return "pgd-explicit";
    case Method::kPgdEuler:
      return "pgd-euler";
  }
  return "unknown";
}

Method methodOf(const std::string& name) {
  std::string list;
  for (const Method method : kMethods) {
    if (toString(method) == name) return method;
    list += (list.empty() ? "" : ", ") + toString(method);
  }
  throw CaseError("= \"" + name + "\" is not known (known: " + list + ")");
}

void checkCase(const Case& c) {
  checkKeys(c);
  if (c.load.any_direction && c.method != Method::kPgdLinear)
    throw CaseError("load.direction = \"any\" does not go with method " + toString(c.method) +
                    ": the answer is not linear in the force; method series-force holds every direction");
  if (c.pgd.tolerance.value_or(1.0) == 0.0 && (bit(c.method) & kStepped) != 0)
    throw CaseError("pgd.tolerance = 0 does not go with method " + toString(c.method) +
                    ": a load step would enrich without end; pgd-linear stops at pgd.greedy_pairs");
  if (c.pgd.hadamard.value_or(false) && c.pgd.block.value_or(1) > 1)
    throw CaseError("pgd.block = " + std::to_string(*c.pgd.block) +
                    " does not go with pgd.separation = \"hadamard\": such pairs are found one at a time");
  if (c.travel && (c.order || c.force_order))
    throw CaseError("target.travel does not go with model.order and model.force_order: it chooses both");
  if (const SeriesOrders orders = c.orders(); !orders.areValid() || orders.answer < orders.leastAnswer())
    throw CaseError("model.force_order = " + std::to_string(orders.answer) +
                    " does not go with fields of order " + std::to_string(orders.fields) + ": expected " +
                    std::to_string(orders.leastAnswer()) + " to " + std::to_string(orders.mostAnswer()));
  if (c.size_limit && !c.handheld())
    throw CaseError("target.size_limit does not go with target.machine = \"server\": it is for handheld");
  if (c.handheld() && c.field_error)
    throw CaseError(
        "target.field_error does not go with target.machine = \"handheld\": target.size_limit chooses the "
        "modes");
  if (c.modes && c.field_error)
    throw CaseError("target.field_error does not go with model.modes: it chooses their number");
  if (c.nodalLoad() && c.patch_radius)
    throw CaseError("model.patch_radius does not go with load.kind = \"node\": such a load has no patch");
  if (c.pgd.greedy_pairs && *c.pgd.greedy_pairs < c.modesOrDefault())
    throw CaseError("pgd.greedy_pairs = " + std::to_string(*c.pgd.greedy_pairs) +
                    " cannot be recompressed to " + std::to_string(c.modesOrDefault()) +
                    " modes; give as many or more");
}

}  // namespace palpate::solver
