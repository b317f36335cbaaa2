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
  if (!by_element.empty() && by_element.size() != elements)
    throw std::invalid_argument("material: " + std::to_string(by_element.size()) + " stiffnesses for " +
                                std::to_string(elements) + " elements");
  std::visit(
      [&](auto this_law) {
        this_law.check(elasticity);
        for (const Elasticity& e : by_element) this_law.check(e);
      },
      law);
}

}  // namespace palpate::solver
