// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/case_lines.h"

#include <charconv>
#include <optional>
#include <utility>

namespace palpate::solver {

namespace {

std::string textOf(const std::string& value) {
  return value;
}
std::string textOf(bool value) {
  return value ? "true" : "false";
}
std::string textOf(int value) {
  return std::to_string(value);
}
/// Digits enough to tell any two numbers apart.
std::string textOf(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
std::string textOf(const Vec3& value) {
  return textOf(value[0]) + "," + textOf(value[1]) + "," + textOf(value[2]);
}

class Lines {
 public:
  template <typename T>
  Lines& add(const std::string& key, const T& value) {
    lines_.push_back(key + " = " + textOf(value));
    return *this;
  }
  template <typename T>
  Lines& add(const std::string& key, const std::optional<T>& value) {
    return value ? add(key, *value) : *this;
  }
  [[nodiscard]] std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

// Structured bindings name every member: one that is added to a case does not compile until it has a line here.

void addLoad(const LoadCase& load, Lines& lines) {
  const auto& [direction, any_direction, magnitude, steps, node, truncation] = load;
  lines.add("load.direction", direction).add("load.direction.any", any_direction);
  lines.add("load.magnitude", magnitude).add("load.steps", steps).add("load.kind.node", node);
  lines.add("load.truncation", truncation);
}

void addPgd(const PgdCase& pgd, Lines& lines) {
  const auto& [hadamard, tolerance, greedy_pairs, sweeps, update, block] = pgd;
  lines.add("pgd.separation.hadamard", hadamard).add("pgd.tolerance", tolerance);
  lines.add("pgd.greedy_pairs", greedy_pairs).add("pgd.sweeps", sweeps);
  lines.add("pgd.update", update).add("pgd.block", block);
}

}  // namespace

std::vector<std::string> linesOf(const Case& c) {
  const auto& [mesh, element_order, mesh_error, fixed, accessible, law, E, nu, regions, springs, method,
               patch_radius, order, force_order, modes, near_radius, target, travel, force_error, field_error,
               size_limit, sweeps, load, pgd, text] = c;
  Lines lines;
  lines.add("mesh.element_order", element_order).add("mesh.error", mesh_error);
  lines.add("boundary.fixed", fixed).add("boundary.accessible", accessible);
  lines.add("material.law", law).add("material.E", E).add("material.nu", nu);
  for (const RegionCase& region : regions) {
    const auto& [group, own_E, own_nu, own_law, place] = region;
    const std::string key = "region " + group;
    lines.add(key + ".E", own_E).add(key + ".nu", own_nu).add(key + ".law", own_law);
  }
  for (const auto& [group, stiffness, place] : springs)
    lines.add("spring " + group + ".stiffness", stiffness);
  lines.add("model.method", toString(method)).add("model.patch_radius", patch_radius);
  lines.add("model.order", order).add("model.force_order", force_order).add("model.modes", modes);
  lines.add("model.near_radius", near_radius).add("model.sweeps", sweeps);
  lines.add("target.machine", std::string(target == Target::kHandheld ? "handheld" : "server"));
  lines.add("target.travel", travel).add("target.force_error", force_error);
  lines.add("target.field_error", field_error).add("target.size_limit", size_limit);
  addLoad(load, lines);
  addPgd(pgd, lines);
  return lines.take();
}

}  // namespace palpate::solver
