// SPDX-License-Identifier: Apache-2.0
#include "tools/make/organ/repair/repairs.h"

#include <algorithm>
#include <cmath>

#include "tools/program/printed.h"

namespace palpate::organ {
namespace {

std::string listed(const std::vector<LoosePiece>& pieces) {
  constexpr std::size_t kMost = 3;
  std::string words;
  for (std::size_t i = 0; i < std::min(pieces.size(), kMost); ++i) {
    const LoosePiece& piece = pieces[i];
    words += (i > 0 ? "; " : "") + program::printed("%zu triangle%s, %.3g cm^2, at (%.4g %.4g %.4g) m",
                                                    piece.triangles, piece.triangles == 1 ? "" : "s",
                                                    1e4 * piece.area, piece.middle[0], piece.middle[1],
                                                    piece.middle[2]);
  }
  return words + (pieces.size() > kMost ? "; ..." : "");
}

}  // namespace

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
  tell(loose.size(), "loose piece left out", "loose pieces left out");
  if (!loose.empty()) lines.back() += ": " + listed(loose);
  tell(crossing_pairs, "pair of triangles crossed", "pairs of triangles crossed");
  tell(crossing_removed, "triangle taken away where they crossed", "triangles taken away where they crossed");
  tell(holes, "hole filled", "holes filled");
  tell(fills, "triangle put into the holes", "triangles put into holes and where triangles were taken away");
  if (lines.empty()) lines.emplace_back("nothing to repair");
  lines.push_back(program::printed(
      "volume %.6g m^3 as the file's triangles face, %.6g m^3 once all face outward, %.6g m^3 "
      "after (%+.2f %%)",
      volume_of_file, volume_before, volume_after,
      100 * (volume_after - volume_before) / std::abs(volume_before)));
  return lines;
}

}  // namespace palpate::organ
