// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/ccx_deck.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "tools/examine/query/query_error.h"

namespace palpate::query {

namespace {

constexpr std::size_t kFieldWidth = 20;      // CalculiX cuts what is longer
constexpr std::size_t kEntriesPerLine = 16;  // and takes no more in one line

/// Each function appends one section of the deck.
class Deck {
 public:
  Deck(const Organ& organ, const FullSolution& solution) : organ_(organ), solution_(solution) {}

  void heading(const std::string& about) {
    out_ << "*HEADING\npalpate, SI units\n** ";
    // A comment ends with its line.
    for (const char c : about.substr(0, 100)) out_ << (c >= ' ' && c <= '~' ? c : '?');
    out_ << '\n';
  }
  void nodes() {
    out_ << "*NODE,NSET=ALL\n";
    for (std::size_t i = 0; i < organ_.mesh.node_tag.size(); ++i) {
      out_ << checked("node", organ_.mesh.node_tag[i]);
      for (std::size_t axis = 0; axis < 3; ++axis) out_ << ',' << ccxNumber(organ_.mesh.nodes[3 * i + axis]);
      out_ << '\n';
    }
  }
  void elements() {
    const bool quadratic = !organ_.mesh.midsides.empty();
    out_ << "*ELEMENT,TYPE=" << (quadratic ? "C3D10" : "C3D4") << ",ELSET=BODY\n";
    for (std::size_t e = 0; e < organ_.mesh.tetrahedron_tag.size(); ++e) {
      out_ << checked("tetrahedron", organ_.mesh.tetrahedron_tag[e]);
      for (std::size_t k = 0; k < 4; ++k) out_ << ',' << number(organ_.mesh.tetrahedra[4 * e + k]);
      for (std::size_t k = 0; quadratic && k < 6; ++k)
        out_ << ',' << number(organ_.mesh.midsides[6 * e + k]);  // C3D10 has them in the order of kTetEdges
      out_ << '\n';
    }
  }
  /// One section for each region.
  void materials() {
    const solver::Material& material = organ_.body.material();
    if (material.regions.empty()) return section("BODY", {"", material.elasticity, material.law});
    for (std::size_t r = 0; r < material.regions.size(); ++r) {
      const std::string set = "REGION" + std::to_string(r + 1);
      std::vector<std::int64_t> elements;
      for (std::size_t e = 0; e < material.region_of_element.size(); ++e)
        if (material.region_of_element[e] == static_cast<std::int32_t>(r))
          elements.push_back(organ_.mesh.tetrahedron_tag[e]);
      if (elements.empty()) continue;
      out_ << "*ELSET,ELSET=" << set;
      list(elements);
      section(set, material.regions[r]);
    }
  }
  /// To ground, an element for each direction. Their numbers follow those of the tetrahedra.
  void springs() {
    std::int64_t next = 0;
    for (const std::int64_t tag : organ_.mesh.tetrahedron_tag) next = std::max(next, tag);
    for (std::size_t s = 0; s < organ_.mesh.spring_node.size(); ++s) {
      std::string stiffness = ccxNumber(organ_.mesh.spring_stiffness[s]);
      // CalculiX takes a whole number here for another degree of freedom.
      if (stiffness.find_first_of(".e") == std::string::npos) stiffness += '.';
      for (int axis = 1; axis <= 3; ++axis) {
        const std::string set = "SPRING" + std::to_string(s + 1) + "_" + std::to_string(axis);
        out_ << "*ELEMENT,TYPE=SPRING1,ELSET=" << set << '\n'
             << checked("spring", ++next) << ',' << number(organ_.mesh.spring_node[s])
             << "\n*SPRING,ELSET=" << set << '\n'
             << axis << '\n'
             << stiffness << '\n';
      }
    }
  }
  void supports() {
    if (organ_.mesh.fixed.empty()) return;
    std::vector<std::int64_t> nodes;
    for (const std::int32_t node : organ_.mesh.fixed) nodes.push_back(number(node));
    out_ << "*NSET,NSET=HELD";
    list(nodes);
    out_ << "*BOUNDARY\nHELD,1,3\n";
  }
  /// Residual and correction down to 1e-9 of the average force and of the largest displacement increment,
  /// also after many iterations, where CalculiX by default lets go.
  void step(int steps) {
    out_ << "*STEP,NLGEOM,INC=1000\n*STATIC\n" << ccxNumber(1.0 / steps) << ",1.,1.e-6\n";
    out_ << "*CONTROLS,PARAMETERS=FIELD\n1.e-9,1.e-9,,,1.e-9\n";
    loads();
    out_ << "*NODE PRINT,NSET=ALL,FREQUENCY=1000\nU\n*END STEP\n";
  }
  [[nodiscard]] std::string text() const { return out_.str(); }

 private:
  void section(const std::string& elements, const solver::Region& region) {
    const solver::CcxMaterial of_deck =
        std::visit([&](auto law) { return law.ccx(region.elasticity); }, region.law);
    out_ << "*MATERIAL,NAME=" << elements << '\n' << of_deck.keyword << '\n';
    for (std::size_t i = 0; i < of_deck.constants.size(); ++i)
      out_ << (i == 0 ? "" : ",") << ccxNumber(of_deck.constants[i]);
    out_ << "\n*SOLID SECTION,ELSET=" << elements << ",MATERIAL=" << elements << '\n';
  }
  void list(const std::vector<std::int64_t>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      out_ << (i % kEntriesPerLine == 0 ? '\n' : ',') << numbers[i];
    out_ << '\n';
  }
  void loads() {
    out_ << "*CLOAD\n";
    for (std::size_t i = 0; i < solution_.patch.nodes.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        out_ << number(solution_.patch.nodes[i]) << ',' << axis + 1 << ','
             << ccxNumber(solution_.patch.weights[i] * solution_.state.force[axis]) << '\n';
  }
  [[nodiscard]] std::int64_t number(std::int32_t node) const {
    return organ_.mesh.node_tag[static_cast<std::size_t>(node)];
  }
  static std::int64_t checked(const char* what, std::int64_t tag) {
    constexpr std::int64_t kLargest = 999'999'999;  // CalculiX reads ten characters
    if (tag >= 1 && tag <= kLargest) return tag;
    throw QueryError(std::string("CalculiX takes the numbers 1 to 999999999, but the mesh has a ") + what +
                     " " + std::to_string(tag));
  }

  const Organ& organ_;
  const FullSolution& solution_;
  std::ostringstream out_;
};

}  // namespace

std::string ccxNumber(double value) {
  std::array<char, 64> text{};
  for (int precision = 17;; --precision) {
    const auto result =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, precision);
    const auto length = static_cast<std::size_t>(result.ptr - text.data());
    if (length <= kFieldWidth || precision == 1) return {text.data(), length};
  }
}

std::string ccxDeck(const Organ& organ, const FullSolution& solution, const std::string& about, int steps) {
  Deck deck(organ, solution);
  deck.heading(about);
  deck.nodes();
  deck.elements();
  deck.materials();
  deck.springs();
  deck.supports();
  deck.step(steps);
  return deck.text();
}

}  // namespace palpate::query
