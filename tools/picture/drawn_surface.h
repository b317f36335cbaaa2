// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/data/region_surfaces.h"

namespace palpate::picture {

/// A closed surface seen from far away, coloured in steps by numbers at its nodes. Borrows positions and triangles.
struct ColouredSurface {
  std::span<const double> positions;           ///< [N][3] m
  std::span<const std::int32_t> triangles;     ///< [T][3] counter-clockwise from outside
  std::vector<std::optional<double>> numbers;  ///< [N]; triangles with a node that has none are grey
  Vec3 towards_eye = Vec3::UnitZ();            ///< unit; up is z, or y where one looks along z
};

/// Steps of the colours: round numbers that cover all that are shown, and zero.
class ColourSteps {
 public:
  explicit ColourSteps(const std::vector<std::optional<double>>& numbers);

  [[nodiscard]] std::size_t count() const { return ends_.size() - 1; }
  /// Where step i begins, and the one before ends.
  [[nodiscard]] double end(std::size_t i) const { return ends_[i]; }
  /// The step that a number lies in; the first or the last beyond them.
  [[nodiscard]] std::size_t stepOf(double number) const;
  /// "#rrggbb". @param light  0 black to 1
  [[nodiscard]] std::string colour(std::size_t step, double light) const;

 private:
  std::vector<double> ends_;
};

/// Where a picture lies, px; y goes down.
struct Frame {
  double left, top, width, tallest;
};

/// World to picture, without perspective: as large as the frame allows.
class Camera {
 public:
  Camera(const ColouredSurface& surface, const Frame& frame);

  /// px, px, and towards the eye, m
  [[nodiscard]] Vec3 place(const Vec3& X) const;
  [[nodiscard]] double scale() const { return scale_; }    ///< px/m
  [[nodiscard]] double bottom() const { return bottom_; }  ///< px
  /// Cosine of the angle between a unit vector and the way to the eye.
  [[nodiscard]] double turnedToEye(const Vec3& normal) const { return axes_.row(2).dot(normal); }

 private:
  Mat3 axes_;
  double scale_, left_, top_, bottom_;
};

/// The triangles that the eye sees as SVG paths, the farthest first, each divided where a step ends.
[[nodiscard]] std::string drawnSurface(const ColouredSurface& surface, const Camera& camera,
                                       const ColourSteps& steps);

/// Something of the closed surface lies between a point on it and the eye. Cost O(T log T).
[[nodiscard]] bool isHidden(const ColouredSurface& surface, const Camera& camera, const Vec3& X);

/// The edge of what the eye would see of a region's surface: data of an SVG path, closed lines.
[[nodiscard]] std::string outlineOf(const RegionSurface& surface, const Camera& camera);

}  // namespace palpate::picture
