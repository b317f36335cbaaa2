// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/model/meta_model.h"
#include "core/tick/shown_surface.h"
#include "core/tick/workspace.h"

namespace palpate::server {

/// What answers poses: a model, and all that lives from tick to tick on it. Another model has another engine, which is made
/// beside this one. The tick writes `work` and `rehearsal`, surface-out writes `shown`; the rest is immutable.
struct Engine {
  /// Allocates all memory. @param number  0 at the start, rises by one with each model that is taken
  /// @throw std::invalid_argument naming the first bad field of config. Real-time: no.
  Engine(std::shared_ptr<const MetaModel> of, const StepConfig& config, std::uint64_t nth = 0)
      : model(std::move(of)),
        organ(*model),
        id(model->id()),
        hash(model->contentHash()),
        number(nth),
        work(organ, config),
        rehearsal(organ, config),
        shown(organ) {}

  const std::shared_ptr<const MetaModel> model;
  const MetaModel& organ;  // the same, for the tick
  const std::string id;
  const std::uint64_t hash;
  const std::uint64_t number;
  Workspace work;
  Workspace rehearsal;  // `work` of a tick ago (docs/decisions/rehearsal.md)
  ShownSurface shown;
};

}  // namespace palpate::server
