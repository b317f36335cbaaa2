// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/solver/base/checkpoint.h"
#include "tools/solver/base/ranks.h"
#include "tools/solver/fit/field_table.h"
#include "tools/solver/series/series_orders.h"

namespace palpate::solver {

struct BuildOptions {
  int workers{1};
  std::filesystem::path scratch{"."};  ///< folder of the scratch file
  bool quiet{false};
  std::filesystem::path output{};     ///< folder of the file that is written later; empty: none
  Checkpoint* checkpoint{nullptr};    ///< keeps what is done; null: nothing is kept
  const Ranks* ranks{&Ranks::one()};  ///< the processes that solve together

  /// Of a scratch file, kept by its name where there is a checkpoint.
  [[nodiscard]] ScratchPlace scratchFile(const char* name) const {
    return checkpoint == nullptr ? ScratchPlace(scratch) : ScratchPlace(checkpoint->folder(), name);
  }
  /// Of a stage; null where nothing is kept.
  [[nodiscard]] Journal* journal(const std::string& stage) const {
    return checkpoint == nullptr ? nullptr : &checkpoint->journal(stage);
  }
};

/// By how much the mesh makes the organ too stiff: n . K_s n of linear elasticity over the same of better elements, less 1.
struct MeshError {
  double mean{0.0};     ///< over the points, of the absolute values
  double largest{0.0};  ///< absolute value
  int points{0};        ///< 0: nowhere could it be looked at, and mean and largest mean nothing
  bool raised{false};   ///< better: quadratic elements; else those near the tool at half the edge length
};

/// Share of touches of up to a travel that are within d_max, in the mean of some places, with these orders.
struct TriedOrders {
  SeriesOrders orders;
  double within;
};

/// The orders that a travel asks for, see ordersFor().
struct TravelOrders {
  double travel;  ///< m
  SeriesOrders orders;
  int reaching;                      ///< places that reach it with these orders
  int places;                        ///< that were tried
  double within;                     ///< share of touches of up to the travel that are within d_max there
  std::vector<TriedOrders> tried{};  ///< by cost
};

/// What edges between contact positions add to the fields, see storeEdgeFields().
struct EdgeChoice {
  std::size_t edges{0};   ///< longer than the patch is wide
  std::size_t solved{0};  ///< and stored; 0 where they add too little
  std::size_t tried{0};   ///< before that was known
  double added{0.0};      ///< second largest of what those tried add, of abs(d) at the travel
};

/// What a size limit chose.
struct SizeChoice {
  double limit;             ///< bytes
  double fixed;             ///< bytes of all but modes and near fields
  double modes;             ///< bytes of the modes
  double near_fields{0.0};  ///< bytes of the near fields
  double left_out{0.0};     ///< near fields leave out what moves a node by less than this part of abs(d)
};

/// Where the time went and how well the modes fit. Members that do not apply to a method stay 0 or empty.
struct BuildReport {
  double factor_seconds{0}, series_seconds{0}, fit_seconds{0};
  double kept_seconds{0};  ///< that earlier runs spent on what this one has taken from its checkpoint
  double mesh_error_seconds{0}, orders_seconds{0};
  double pgd_seconds{0}, recompression_seconds{0};
  std::vector<double> fit_errors;         ///< series methods: after each sweep, see FarField::errors
  double fit_p95{0}, fit_max{0};          ///< series-displacement: FarField::largest over the positions
  double median_edge{0};                  ///< of the surface, corner to corner, m
  std::optional<MeshError> mesh_error{};  ///< where the case asks for it
  std::optional<TravelOrders> travel{};   ///< where it chose the orders
  std::optional<SizeChoice> size{};       ///< where the case has a limit
  EdgeChoice edges{};                     ///< series-displacement
  double shared_loads{0};                 ///< SharedLoads::error, where loads are shared
  double fit_asked{0};                    ///< of fit_p95, where it chose the modes: the case's field_error
  int greedy_pairs{0};                    ///< PGD methods: pairs before recompression
  double residual{0};         ///< PGD methods: of the last enrichment, dual norm, relative, an estimate
  double truncation{0};       ///< PGD methods: relative energy norm of what recompression drops
  double load_truncation{0};  ///< pgd-linear: relative error of m terms, Eq. (2), in nodal forces
  double load{0};             ///< PGD methods: N
  int weak_positions{0};      ///< load-driven: positions where the modes are too few to invert dd/df
};

}  // namespace palpate::solver
