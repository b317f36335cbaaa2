// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/surface.h"

#include <algorithm>
#include <cmath>

#include "palpate/client/error.h"

namespace palpate::client {
namespace {

// Refuses what is in `part`, e.g. "region 2: ".
struct Refusal {
  std::string part;
  [[noreturn]] void operator()(const std::string& what) const {
    throw ClientError("surface from the server: " + part + what);
  }
};

void expectSize(const char* field, std::size_t found, std::size_t expected) {
  if (found != expected)
    Refusal{}(std::string(field) + " has " + std::to_string(found) + " entries, expected " +
              std::to_string(expected));
}

template <class Message, class Kept>
void copyPositions(const Message& message, Kept& kept, const Refusal& refuse) {
  const auto& from = message.positions;
  if (from._length % 3 != 0)
    refuse("positions has " + std::to_string(from._length) + " entries, expected 3 for each node");
  for (std::uint32_t i = 0; i < from._length; i += 3) {
    const device::Point X{from._buffer[i], from._buffer[i + 1], from._buffer[i + 2]};
    if (!std::isfinite(dot(X, X))) refuse("position of node " + std::to_string(i / 3) + " is not finite");
    kept.positions.push_back(X);
  }
}

template <class Message, class Kept>
void copyTriangles(const Message& message, Kept& kept, const Refusal& refuse) {
  const auto& from = message.triangles;
  if (from._length % 3 != 0)
    refuse("triangles has " + std::to_string(from._length) + " entries, expected 3 for each triangle");
  for (std::uint32_t i = 0; i < from._length; ++i)
    if (from._buffer[i] >= kept.positions.size())
      refuse("triangle " + std::to_string(i / 3) + " names node " + std::to_string(from._buffer[i]) + " of " +
             std::to_string(kept.positions.size()));
  for (std::uint32_t i = 0; i < from._length; i += 3)
    kept.triangles.push_back({from._buffer[i], from._buffer[i + 1], from._buffer[i + 2]});
}

void copyRegions(const dds::SurfaceMesh& message, Surface& surface) {
  for (std::uint32_t r = 0; r < message.regions._length; ++r) {
    const dds::Region& from = message.regions._buffer[r];
    const Refusal refuse{"region " + std::to_string(r) + ": "};
    if (!(from.youngs_modulus > 0.0 && std::isfinite(from.youngs_modulus)))
      refuse("youngs_modulus is " + std::to_string(from.youngs_modulus) + " Pa, expected more than 0");
    Region& region = surface.regions.emplace_back();
    region.name = from.name;
    region.youngs_modulus = from.youngs_modulus;
    copyPositions(from, region, refuse);
    copyTriangles(from, region, refuse);
  }
}

// Sum of the triangles' normals around a node, each weighted by its angle there.
device::Point normalAt(const Surface& surface, std::uint32_t node) {
  device::Point sum{};
  for (const auto& triangle : surface.triangles) {
    const auto corner = std::find(triangle.begin(), triangle.end(), node) - triangle.begin();
    if (corner == 3) continue;
    const device::Point a = surface.positions[triangle[(corner + 1) % 3]] - surface.positions[node];
    const device::Point b = surface.positions[triangle[(corner + 2) % 3]] - surface.positions[node];
    const device::Point cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                              a[0] * b[1] - a[1] * b[0]};
    const double area = length(cross);
    if (area > 0.0) sum = sum + (std::atan2(area, dot(a, b)) / area) * cross;
  }
  return sum;
}

// Accessible nodes whose triangles have only accessible corners; without such a node, all accessible nodes.
std::vector<std::uint32_t> candidates(const Surface& surface) {
  std::vector<std::uint8_t> inner = surface.accessible;
  for (const auto& triangle : surface.triangles)
    for (const std::uint32_t corner : triangle)
      if (surface.accessible[corner] == 0)
        for (const std::uint32_t other : triangle) inner[other] = 0;
  const auto collect = [](const std::vector<std::uint8_t>& mask) {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t i = 0; i < mask.size(); ++i)
      if (mask[i] != 0) nodes.push_back(i);
    return nodes;
  };
  const auto nodes = collect(inner);
  return nodes.empty() ? collect(surface.accessible) : nodes;
}

void checkPrintable(const char* field, const std::string& text) {
  for (const char c : text)
    if (c < ' ' || c > '~') Refusal{}(std::string(field) + " holds an unprintable character");
}

}  // namespace

Surface checkedSurface(const dds::SurfaceMesh& message) {
  Surface surface;
  surface.organ_id = message.organ_id;
  surface.session = message.session;
  surface.model_id = message.model_id;
  checkPrintable("model_id", surface.model_id);
  surface.topology_revision = message.topology_revision;
  copyPositions(message, surface, {});
  copyTriangles(message, surface, {});
  if (surface.triangles.empty()) Refusal{}("triangles has 0 entries, expected 3 for each triangle");
  expectSize("accessible", message.accessible._length, surface.positions.size());
  expectSize("mesh_tags", message.mesh_tags._length, surface.positions.size());
  // Of an older server, which does not say it: zeros.
  if (message.clamped._length != 0) expectSize("clamped", message.clamped._length, surface.positions.size());
  surface.accessible.assign(message.accessible._buffer,
                            message.accessible._buffer + message.accessible._length);
  surface.mesh_tags.assign(message.mesh_tags._buffer, message.mesh_tags._buffer + message.mesh_tags._length);
  surface.clamped.assign(message.clamped._buffer, message.clamped._buffer + message.clamped._length);
  surface.clamped.resize(surface.positions.size());
  copyRegions(message, surface);
  surface.contact_radius = message.contact_radius;
  if (!(surface.contact_radius >= 0.0 && std::isfinite(surface.contact_radius)))
    Refusal{}("contact_radius is " + std::to_string(surface.contact_radius) + " m, expected 0 or more");
  surface.certificate = message.certificate;
  checkPrintable("certificate", surface.certificate);
  return surface;
}

Spot chooseSpot(const Surface& surface, const std::optional<device::Point>& at) {
  const auto cost = [&](std::uint32_t node) {
    const device::Point& X = surface.positions[node];
    return at ? length(X - *at) : -X[2];
  };
  const auto nodes = candidates(surface);
  if (nodes.empty()) throw ClientError("no node of the organ's surface is accessible");
  const std::uint32_t node =
      *std::min_element(nodes.begin(), nodes.end(), [&](auto a, auto b) { return cost(a) < cost(b); });
  const device::Point sum = normalAt(surface, node);
  const double size = length(sum);
  constexpr double kLeast = 1e-100;  // rad; the squares of much smaller angles have lost their digits
  if (!(size > kLeast && std::isfinite(size)))
    throw ClientError("the surface has no normal at node " + std::to_string(node));
  return {node, surface.mesh_tags[node], surface.positions[node], (1.0 / size) * sum};
}

}  // namespace palpate::client
