// SPDX-License-Identifier: Apache-2.0
// The organ at rest, for a page that draws it.
#include <emscripten.h>

#include <string>

#include "core/wasm/organ.h"

namespace palpate {

namespace {

const RegionSurface& regionAt(int region) {
  return organ->regions[static_cast<std::size_t>(region)];
}

}  // namespace

extern "C" {

/// The rest surface: [nodes][3] doubles, m; triangles; [nodes] bytes.
EMSCRIPTEN_KEEPALIVE const double* palpate_positions() {
  return organ->model.view().surface_positions.data();
}
EMSCRIPTEN_KEEPALIVE int palpate_triangle_count() {
  return static_cast<int>(organ->model.view().triangles());
}
EMSCRIPTEN_KEEPALIVE const std::int32_t* palpate_triangles() {
  return organ->model.view().surface_triangles.data();
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* palpate_accessible() {
  return organ->accessible.data();
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* palpate_clamped() {
  return organ->clamped.data();
}

/// Where regions end inside: how many, and of each its name, E in Pa, nodes and triangles.
EMSCRIPTEN_KEEPALIVE int palpate_regions() {
  return static_cast<int>(organ->regions.size());
}
EMSCRIPTEN_KEEPALIVE const char* palpate_region_name(int region) {
  static std::string said;
  said = textOf(organ->model.view().region_name[static_cast<std::size_t>(region)]);
  return said.c_str();
}
EMSCRIPTEN_KEEPALIVE double palpate_region_modulus(int region) {
  return organ->model.view().region_E[static_cast<std::size_t>(region)];
}
EMSCRIPTEN_KEEPALIVE int palpate_region_nodes(int region) {
  return static_cast<int>(regionAt(region).positions.size() / 3);
}
EMSCRIPTEN_KEEPALIVE const double* palpate_region_positions(int region) {
  return regionAt(region).positions.data();
}
EMSCRIPTEN_KEEPALIVE int palpate_region_triangle_count(int region) {
  return static_cast<int>(regionAt(region).triangles.size() / 3);
}
EMSCRIPTEN_KEEPALIVE const std::uint32_t* palpate_region_triangles(int region) {
  return regionAt(region).triangles.data();
}

}  // extern "C"

}  // namespace palpate
