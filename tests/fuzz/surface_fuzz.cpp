// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "palpate/client/error.h"
#include "palpate/client/surface.h"
#include "targets.h"

namespace palpate::fuzz {

namespace {

// Small whole numbers, or any bits.
double coordinate(Source& source, bool any) {
  return any ? source.get<double>() : source.get<std::int8_t>();
}

template <class T, class Take>
std::vector<T> numbers(std::size_t count, const Take& take) {
  std::vector<T> all(count);
  for (T& number : all) number = take();
  return all;
}

void look(const client::Surface& surface) {
  for (const auto& triangle : surface.triangles)
    for (const std::uint32_t corner : triangle)
      require(corner < surface.positions.size(), "corners are nodes");
  require(surface.accessible.size() == surface.positions.size() &&
              surface.mesh_tags.size() == surface.positions.size() &&
              surface.clamped.size() == surface.positions.size(),
          "each node has what nodes have");
  const client::Spot spot = client::chooseSpot(surface, std::nullopt);
  require(std::abs(length(spot.normal) - 1.0) < 1e-9, "a normal is a unit vector");
}

}  // namespace

bool surface(Bytes input) {
  Source source(input);
  const auto form = source.get<std::uint8_t>();
  const bool any = (form & 1) != 0;
  const std::size_t nodes = source.get<std::uint8_t>() % 16, triangles = source.get<std::uint8_t>() % 16;
  const auto more = [&](int bit) { return static_cast<std::size_t>((form >> bit) & 1); };  // than fit
  const auto positions = numbers<double>(3 * nodes + more(1), [&] { return coordinate(source, any); });
  const auto corners = numbers<std::uint32_t>(3 * triangles + more(2), [&] {
    return any ? source.get<std::uint32_t>() : source.get<std::uint8_t>();
  });
  const auto accessible = numbers<std::uint8_t>(nodes + more(3), [&] { return source.get<std::uint8_t>(); });
  const auto tags =
      numbers<std::int64_t>(nodes + more(4), [&] { return any ? source.get<std::int64_t>() : 0; });
  const std::vector<std::uint8_t> clamped(more(5) * (nodes + more(6)));
  dds::Region region{};
  dds::assignText(region.name, source.text(4));
  region.youngs_modulus = coordinate(source, any);
  dds::lend(region.positions, positions.data(), positions.size());
  dds::lend(region.triangles, corners.data(), corners.size());

  dds::SurfaceMesh message{};
  dds::lend(message.positions, positions.data(), positions.size());
  dds::lend(message.triangles, corners.data(), corners.size());
  dds::lend(message.accessible, accessible.data(), accessible.size());
  dds::lend(message.mesh_tags, tags.data(), tags.size());
  dds::lend(message.clamped, clamped.data(), clamped.size());
  dds::lend(message.regions, &region, more(7));
  message.contact_radius = coordinate(source, any);
  dds::assignText(message.model_id, source.text(4));
  dds::assignText(message.certificate, source.text(8));
  try {
    look(client::checkedSurface(message));
  } catch (const client::ClientError&) {
    return false;
  }
  return true;
}

}  // namespace palpate::fuzz
