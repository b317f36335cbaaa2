// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/repair/repairs.h"

#include <cmath>
#include <cstdio>

namespace palpate::organ {

std::vector<std::string> Repairs::inWords() const {
  std::vector<std::string> lines;
  const auto tell = [&](std::size_t count, const char* one, const char* several) {
    if (count > 0) lines.push_back(std::to_string(count) + ' ' + (count == 1 ? one : several));
  };
  tell(not_finite, "triangle left out whose coordinates are not finite",
       "triangles left out whose coordinates are not finite");
  tell(merged, "vertex merged with its neighbour", "vertices merged with their neighbours");
  tell(twins, "triangle left out that was there twice", "triangles left out that were there twice");
  tell(flat, "triangle without area left out", "triangles without area left out");
  tell(turned_over, "triangle turned over", "triangles turned over");
  tell(stitched, "pair of edges side by side stitched", "pairs of edges side by side stitched");
  tell(loose, "triangle of a loose piece left out", "triangles of loose pieces left out");
  tell(crossing_pairs, "pair of triangles crossed", "pairs of triangles crossed");
  tell(crossing_removed, "triangle taken away where they crossed", "triangles taken away where they crossed");
  tell(holes, "hole filled", "holes filled");
  tell(fills, "triangle put into the holes", "triangles put into holes and where triangles were taken away");
  if (lines.empty()) lines.emplace_back("nothing to repair");
  char text[200];
  std::snprintf(text, sizeof text,
                "volume %.6g m^3 as the file's triangles face, %.6g m^3 once all face outward, %.6g m^3 "
                "after (%+.2f %%)",
                volume_of_file, volume_before, volume_after,
                100 * (volume_after - volume_before) / std::abs(volume_before));
  lines.emplace_back(text);
  return lines;
}

}  // namespace palpate::organ
