// SPDX-License-Identifier: Apache-2.0
#include "tools/solver/build/case_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tools/mesh/quadratic.h"
#include "tools/solver/build/case_section.h"
#include "tools/solver/fem/material.h"

namespace palpate::solver {

namespace {

template <typename T, typename U>
void assign(T& target, const std::optional<U>& value) {
  if (value) target = *value;
}

void readBoundary(const std::string& file, const toml::table& table, Case& c) {
  Section section(file, "boundary", table);
  assign(c.fixed, section.take<std::string>("fixed", "a string"));
  assign(c.accessible, section.take<std::string>("accessible", "a string"));
  section.refuseTheRest();
}

std::optional<std::string> readLaw(Section& section) {
  std::optional<std::string> law = section.take<std::string>("law", "a string");
  try {
    if (law) (void)lawOf(*law);
  } catch (const std::invalid_argument& error) {
    section.refuse(section.node("law"), "law", error.what());
  }
  return law;
}
std::optional<double> readE(Section& section) {
  return section.number("E");
}
std::optional<double> readNu(Section& section) {
  return section.number("nu");
}

void readMaterial(const std::string& file, const toml::table& table, Case& c) {
  Section section(file, "material", table);
  assign(c.law, readLaw(section));
  assign(c.E, readE(section));
  assign(c.nu, readNu(section));
  section.refuseTheRest();
}

std::string readGroup(Section& section) {
  return section.required("group", section.take<std::string>("group", "a string"));
}

RegionCase readRegion(Section& section) {
  RegionCase region;
  region.group = readGroup(section);
  region.place = section.placeOf(section.node("group"), "group");
  region.E = section.required("E", readE(section));
  region.nu = readNu(section);
  region.law = readLaw(section);
  return region;
}

SpringCase readSpring(Section& section) {
  SpringCase spring;
  spring.group = readGroup(section);
  spring.place = section.placeOf(section.node("group"), "group");
  spring.stiffness = section.required("stiffness", section.number("stiffness"));
  return spring;
}

/// One of two words. @return whether it is the second
std::optional<bool> choice(Section& section, const std::string& key, const std::string& no,
                           const std::string& yes) {
  const std::optional<std::string> word = section.take<std::string>(key, "a string");
  if (word && *word != no && *word != yes)
    section.refuse(section.node(key), key,
                   "= \"" + *word + "\" is not known (known: " + no + ", " + yes + ")");
  return word ? std::optional<bool>(*word == yes) : std::nullopt;
}

void readModel(const std::string& file, const toml::table& table, Case& c) {
  Section section(file, "model", table);
  if (const auto name = section.take<std::string>("method", "a string")) {
    try {
      c.method = methodOf(*name);
    } catch (const CaseError& error) {
      section.refuse(section.node("method"), "method", error.what());
    }
  }
  c.patch_radius = section.number("patch_radius");
  c.order = section.integer("order");
  c.force_order = section.integer("force_order");
  c.modes = section.integer("modes");
  c.near_radius = section.number("near_radius");
  c.sweeps = section.integer("sweeps");
  section.refuseTheRest();
}

void readTarget(const std::string& file, const toml::table& table, Case& c) {
  Section section(file, "target", table);
  if (choice(section, "machine", "server", "handheld").value_or(false)) c.target = Target::kHandheld;
  c.travel = section.number("travel");
  c.force_error = section.number("force_error");
  c.field_error = section.number("field_error");
  c.size_limit = section.number("size_limit");
  section.refuseTheRest();
}

/// Three numbers, not all zero, or "any".
void readDirection(Section& section, LoadCase& load) {
  const toml::node* node = section.find("direction");
  if (node == nullptr) return;
  if (node->value_exact<std::string>() == "any") {
    load.any_direction = true;
    return;
  }
  const toml::array* list = node->as_array();
  Vec3 x = Vec3::Zero();
  bool good = list != nullptr && list->size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    good = (*list)[i].is_number();
    if (good) x[static_cast<Eigen::Index>(i)] = *(*list)[i].value<double>();
  }
  if (!good || !x.allFinite() || !(x.norm() > 0.0))
    section.refuse(*node, "direction", "is neither three numbers, not all zero, nor \"any\"");
  load.direction = x.stableNormalized();
}

void readLoad(const std::string& file, const toml::table& table, Case& c) {
  Section section(file, "load", table);
  readDirection(section, c.load);
  c.load.magnitude = section.number("magnitude");
  c.load.steps = section.integer("steps");
  c.load.node = choice(section, "kind", "patch", "node");
  c.load.truncation = section.integer("truncation");
  section.refuseTheRest();
}

void readPgd(const std::string& file, const toml::table& table, Case& c) {
  Section section(file, "pgd", table);
  c.pgd.hadamard = choice(section, "separation", "scalar", "hadamard");
  c.pgd.tolerance = section.number("tolerance");
  c.pgd.greedy_pairs = section.integer("greedy_pairs");
  c.pgd.sweeps = section.integer("sweeps");
  c.pgd.update = section.integer("update");
  c.pgd.block = section.integer("block");
  section.refuseTheRest();
}

std::string readText(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) throw CaseError(path.string() + ": cannot be read");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

Case readCase(const std::filesystem::path& path) {
  return parseCase(path, readText(path));
}

Case parseCase(const std::filesystem::path& path, std::string text) {
  const std::string file = path.string();
  Case c;
  c.text = std::move(text);
  toml::table root;
  try {
    root = toml::parse(c.text, file);
  } catch (const toml::parse_error& error) {
    throw CaseError(file + ":" + std::to_string(error.source().begin.line) + ": " +
                    std::string(error.description()));
  }
  Section section(file, "", root);
  std::optional<std::string> mesh;
  if (const toml::node* node = root.get("mesh"); node != nullptr && node->is_table()) {
    Section part(file, "mesh", *section.table("mesh"));
    mesh = part.take<std::string>("file", "a string");
    c.element_order = part.integer("element_order");
    assign(c.mesh_error, part.take<bool>("error", "true or false"));
    part.refuseTheRest();
    if (!mesh) throw CaseError(file + ": mesh.file is missing");
  } else {
    mesh = section.take<std::string>("mesh", "a string or a table");
  }
  if (const toml::table* t = section.table("boundary")) readBoundary(file, *t, c);
  if (const toml::table* t = section.table("material")) readMaterial(file, *t, c);
  section.tables("region", [&](Section& of) { c.regions.push_back(readRegion(of)); });
  section.tables("spring", [&](Section& of) { c.springs.push_back(readSpring(of)); });
  if (const toml::table* t = section.table("model")) readModel(file, *t, c);
  if (const toml::table* t = section.table("target")) readTarget(file, *t, c);
  if (const toml::table* t = section.table("load")) readLoad(file, *t, c);
  if (const toml::table* t = section.table("pgd")) readPgd(file, *t, c);
  section.refuseTheRest();
  if (!mesh) throw CaseError(file + ": mesh is missing");
  c.mesh = path.parent_path() / *mesh;
  return c;
}

mesh::TetMesh raised(const Case& c, mesh::TetMesh mesh) {
  constexpr double kLocks = 0.3;  // nu above which linear elements are much too stiff
  double nu = c.nu;
  for (const RegionCase& region : c.regions) nu = std::max(nu, region.nu.value_or(c.nu));
  const int suits = c.method == Method::kSeriesDisplacement && nu > kLocks ? 2 : 1;
  if (mesh.isQuadratic() && c.element_order == 1)
    throw CaseError("mesh.element_order = 1 does not go with " + c.mesh.string() +
                    ", whose elements are quadratic");
  if (mesh.isQuadratic() || c.element_order.value_or(suits) == 1) return mesh;
  return mesh::quadraticOf(mesh);
}

Case defaultCase(const std::filesystem::path& mesh) {
  Case c;
  c.mesh = mesh;
  return c;
}

}  // namespace palpate::solver
