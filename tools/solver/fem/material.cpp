// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/fem/material.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/data/model_view.h"

namespace palpate::solver {

namespace {

template <typename Visit, std::size_t... I>
void forEachLaw(const Visit& visit, std::index_sequence<I...> /*all*/) {
  (visit(std::variant_alternative_t<I, Law>{}), ...);
}
template <typename Visit>
void forEachLaw(const Visit& visit) {
  forEachLaw(visit, std::make_index_sequence<std::variant_size_v<Law>>{});
}

template <std::size_t... I>
constexpr bool modelFilesKnowAll(std::index_sequence<I...> /*all*/) {
  return ((std::find(kLaws.begin(), kLaws.end(), std::variant_alternative_t<I, Law>::kName) != kLaws.end()) &&
          ...);
}
static_assert(modelFilesKnowAll(std::make_index_sequence<std::variant_size_v<Law>>{}),
              "a law is not in core's kLaws");

}  // namespace

Law lawOf(std::string_view name) {
  Law found;
  bool known = false;
  std::string names;
  forEachLaw([&](auto law) {
    names += (names.empty() ? "" : ", ") + std::string(law.kName);
    if (law.kName != name) return;
    found = law;
    known = true;
  });
  if (!known)
    throw std::invalid_argument("= \"" + std::string(name) + "\" is not known (known: " + names + ")");
  return found;
}

void Material::check(std::size_t elements) const {
  const auto check = [](const Law& of, const Elasticity& e) {
    std::visit([&](auto this_law) { this_law.check(e); }, of);
  };
  check(law, elasticity);
  for (const Region& region : regions) check(region.law, region.elasticity);
  if (region_of_element.size() != (regions.empty() ? 0 : elements))
    throw std::invalid_argument("material: regions of " + std::to_string(region_of_element.size()) +
                                " elements for " + std::to_string(elements));
  for (const std::int32_t region : region_of_element)
    if (region < 0 || region >= static_cast<std::int32_t>(regions.size()))
      throw std::invalid_argument("material: region " + std::to_string(region) + " of " +
                                  std::to_string(regions.size()));
}

}  // namespace palpate::solver
