// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/contact_point.h"
#include "core/data/region_surfaces.h"
#include "core/model/meta_model.h"

namespace palpate::feel {

/// Two models that cannot be compared. what() is one line that names the first difference.
class ModelsDiffer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An organ and the same organ without what is to be felt in it. Borrows both models.
struct Pair {
  const MetaModel& model;
  const MetaModel& without;
};

/// One press, straight in along the normal, of both organs.
struct Press {
  double force;          ///< normal force of the tool on the organ, N
  double without_force;  ///< the same of the organ without, N
  bool beyond;           ///< deeper than d_max of one of them

  [[nodiscard]] double contrast() const noexcept { return force / without_force - 1.0; }
};

/// What a press at each surface node says.
struct ContrastField {
  std::vector<std::optional<Press>>
      presses;                ///< [Ns]; none where no tool may be, or an organ does not push back
  std::vector<double> area;   ///< [Ns] a third of the triangles round the node, m^2
  std::size_t unanswered{0};  ///< accessible nodes without a press

  [[nodiscard]] std::size_t places() const;
  [[nodiscard]] std::size_t beyond() const;
};

/// The contrast over the nodes whose distance from a place is in [from, to).
struct Ring {
  double from, to;        ///< m, straight; the last one ends at infinity
  std::size_t places;     ///< 0: the next three say nothing
  double mean, min, max;  ///< mean by area
};

/// A region, and the contrast at the surface point nearest to its centre.
struct RegionContrast {
  std::string name;
  RegionSurface surface;
  Vec3 above;                  ///< that point, m
  std::optional<Press> press;  ///< none where no tool may be
};

/// @throw ModelsDiffer unless surface, contact positions and patch radius are the same, number by number
void checkComparable(const Pair& pair);

/// @param[in] depth  m  @return none where no tool may be, or one of the organs does not push back
[[nodiscard]] std::optional<Press> pressAt(const Pair& pair, const ContactPoint& s, double depth);

/// Presses every accessible surface node; where elements are quadratic, middles of edges too.
[[nodiscard]] ContrastField contrastField(const Pair& pair, double depth);

/// The node with the largest contrast. @throw ModelsDiffer when no node has one
[[nodiscard]] std::size_t largest(const ContrastField& field);

/// Rings 10 mm wide round a node: about it, 10, 20, 30 and 40 mm beside it, and the rest of the surface.
[[nodiscard]] std::vector<Ring> ringsRound(const MetaModel& model, const ContrastField& field,
                                           std::size_t node);

/// The part of the touchable surface whose contrast is above a level.
[[nodiscard]] double shareAbove(const ContrastField& field, double level);

/// All regions of `model` that a case names, with tetrahedra; the tissue round them, "elsewhere", is none.
[[nodiscard]] std::vector<RegionContrast> regionContrasts(const Pair& pair, double depth);

}  // namespace palpate::feel
