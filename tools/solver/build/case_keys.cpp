// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/case_keys.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

#include "tools/solver/series/series_orders.h"

namespace palpate::solver {

namespace {

using Type = CaseKey::Type;
constexpr bool kOpen = false;   // low is not included
constexpr bool kActive = true;  // the default, whatever the mesh and the method

constexpr std::array kKeys{
    CaseKey{"mesh", "file", Type::kWord, 0, 0, true, "", "", kActive,
            "volume mesh in metres; relative to this file"},
    CaseKey{"mesh", "element_order", Type::kWhole, 1, 2, true, "", "2", false,
            "2 raises a linear mesh to quadratic elements; absent: 2 for series-displacement and nu > 0.3"},
    CaseKey{"mesh", "error", Type::kFlag, 0, 0, true, "", "false", kActive,
            "series-displacement: say by how much the mesh makes the organ too stiff"},
    CaseKey{"boundary", "fixed", Type::kWord, 0, 0, true, "", "\"fixed\"", kActive,
            "group of the mesh that is clamped"},
    CaseKey{"boundary", "accessible", Type::kWord, 0, 0, true, "", "\"accessible\"", false,
            "group that tools may touch; absent: the whole surface but the clamped nodes"},
    CaseKey{"material", "law", Type::kWord, 0, 0, true, "", "\"stvk\"", kActive,
            "or \"stable-neo-hookean\", for soft tissue and long travel"},
    CaseKey{"material", "E", Type::kNumber, 0, 1e12, kOpen, "Pa", "160e3", kActive,
            "Young's modulus; soft organs have 1e3 to 1e6 Pa"},
    CaseKey{"material", "nu", Type::kNumber, -0.99, 0.4999, true, "", "0.48", kActive, "Poisson's ratio"},
    CaseKey{"region", "group", Type::kWord, 0, 0, true, "", "\"nodule\"", false,
            "any number of regions: a volume group of the mesh with its own material"},
    CaseKey{"region", "E", Type::kNumber, 0, 1e12, kOpen, "Pa", "70e3", false, "Young's modulus, required"},
    CaseKey{"region", "nu", Type::kNumber, -0.99, 0.4999, true, "", "0.48", false,
            "absent: as in [material]"},
    CaseKey{"region", "law", Type::kWord, 0, 0, true, "", "\"stvk\"", false, "absent: as in [material]"},
    CaseKey{"spring", "group", Type::kWord, 0, 0, true, "", "\"bed\"", false,
            "any number of beds, stress-free at rest: a group of boundary faces"},
    CaseKey{"spring", "stiffness", Type::kNumber, 0, 1e15, kOpen, "N/m^3", "1e6", false, "required"},
    CaseKey{"model", "method", Type::kWord, 0, 0, true, "", "\"series-displacement\"", kActive,
            "or series-force, pgd-linear, pgd-explicit, pgd-euler"},
    CaseKey{"model", "patch_radius", Type::kNumber, 0, 1, kOpen, "m", "0.008", false,
            "of the tool's contact; absent: 1.3 median surface edges, 0.8 of quadratic elements"},
    CaseKey{"model", "order", Type::kWhole, 1, 7, true, "", "4", false,
            "series: degree of the fields; absent: chosen by the travel, of series-force 3"},
    CaseKey{"model", "force_order", Type::kWhole, 2, 8, true, "", "6", false,
            "series-displacement: degree of the force, from order to 2 order; absent: 2 order, at most 6"},
    CaseKey{"model", "modes", Type::kWhole, 1, 2000, true, "", "167", false,
            "absent: series-displacement: as many as field_error wants, else 167"},
    CaseKey{"model", "near_radius", Type::kNumber, 0, 1, true, "m", "0.036", false,
            "series-displacement; absent: 4.5 patch_radius, or more where the field's error wants it"},
    CaseKey{"model", "sweeps", Type::kWhole, 1, 1000, true, "", "3", false,
            "series: of the fit of the modes; absent: 3, of series-force 6"},
    CaseKey{"target", "travel", Type::kNumber, 0, kLargestRadius, kOpen, "m", "0.005", false,
            "how far tools press; chooses the orders; absent: 0.007 where E is below 50 kPa, else 0.005"},
    CaseKey{"target", "force_error", Type::kNumber, 0, 0.999, kOpen, "", "0.01", kActive,
            "series-displacement: of the force within the domain, relative"},
    CaseKey{"target", "field_error", Type::kNumber, 0, 0.999, kOpen, "", "0.01", kActive,
            "series-displacement: largest error of the field over abs(d); not beside modes"},
    CaseKey{"target", "machine", Type::kWord, 0, 0, true, "", "\"server\"", kActive,
            "or \"handheld\": a small file for a phone or a page"},
    CaseKey{"target", "size_limit", Type::kNumber, 1e5, 1e12, true, "bytes", "8e6", false,
            "handheld: of the file; absent: 8e6, or 20e6 where order or travel are above 3 and 0.004"},
    CaseKey{"load", "direction", Type::kVector, 0, 0, true, "", "[0, 0, -1]", false,
            "PGD methods: three numbers, not all zero; pgd-linear also \"any\""},
    CaseKey{"load", "magnitude", Type::kNumber, 0, 1e6, kOpen, "N", "1.0", false,
            "PGD methods; absent: what moves the median contact by 2 mm"},
    CaseKey{"load", "steps", Type::kWhole, 1, 100000, true, "", "30", false, "pgd-explicit, pgd-euler"},
    CaseKey{"load", "kind", Type::kWord, 0, 0, true, "", "\"patch\"", false,
            "PGD methods: or \"node\", a single nodal force"},
    CaseKey{"load", "truncation", Type::kWhole, 0, 100000, true, "", "0", false,
            "pgd-linear: terms m of Eq. (2), 0 for the load itself"},
    CaseKey{"pgd", "separation", Type::kWord, 0, 0, true, "", "\"scalar\"", false,
            "pgd-linear: or \"hadamard\", component by component as in Eq. (3)"},
    CaseKey{"pgd", "tolerance", Type::kNumber, 0, 0.999, true, "", "1e-3", false,
            "PGD methods: of the residual, relative; absent: 1e-3, of load steps 0.1"},
    CaseKey{"pgd", "greedy_pairs", Type::kWhole, 1, 100000, true, "", "251", false,
            "PGD methods: at most, before recompression; absent: 1.5 modes"},
    CaseKey{"pgd", "sweeps", Type::kWhole, 1, 1000, true, "", "3", false,
            "PGD methods: alternating directions of a pair"},
    CaseKey{"pgd", "update", Type::kWhole, 0, 100000, true, "", "8", false,
            "pgd-linear: all Y again every so many pairs, 0: never"},
    CaseKey{"pgd", "block", Type::kWhole, 1, 1000, true, "", "8", false,
            "pgd-linear, scalar: pairs iterated at once"},
};

bool isList(std::string_view table) {
  return table == "region" || table == "spring";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string lineOf(const CaseKey& key, const std::string& value, bool active) {
  constexpr std::size_t kColumn = 34;  // where comments begin
  std::string line = (active ? "" : "# ") + std::string(key.name) + " = " + value;
  line.resize(std::max(line.size() + 2, kColumn), ' ');
  const std::string range = rangeText(key);
  return line + "# " + std::string(key.help) + (range.empty() ? "" : "; " + range) + '\n';
}

}  // namespace

std::span<const CaseKey> caseKeys() {
  return kKeys;
}

const CaseKey& caseKey(std::string_view table, std::string_view name) {
  const auto found = std::find_if(kKeys.begin(), kKeys.end(),
                                  [&](const CaseKey& key) { return key.table == table && key.name == name; });
  if (found == kKeys.end())
    throw std::logic_error("case key " + std::string(table) + "." + std::string(name) + " is not declared");
  return *found;
}

std::string rangeText(const CaseKey& key) {
  if (key.type != Type::kNumber && key.type != Type::kWhole) return {};
  std::ostringstream text;
  text << (key.low_included ? "" : "above ") << key.low << (key.low_included ? " to " : ", at most ")
       << key.high;
  if (!key.unit.empty()) text << ' ' << key.unit;
  return text.str();
}

std::string caseTemplate(const std::string& mesh, bool accessible) {
  std::string text =
      "# A case of palpate-solve: every key, with its default, unit and range. SI units.\n"
      "# A key behind # has a default that depends on the mesh or the method, or needs another method: what "
      "stands there is "
      "an example.\n";
  std::string_view table;
  for (const CaseKey& key : kKeys) {
    if (key.table != table) {
      table = key.table;
      text += isList(table) ? "\n# [[" + std::string(table) + "]]\n" : "\n[" + std::string(table) + "]\n";
    }
    text += lineOf(key, key.name == "file" ? quoted(mesh) : std::string(key.value),
                   key.active || (accessible && key.name == "accessible"));
  }
  return text;
}

}  // namespace palpate::solver
