// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/data/array_reader.h"
#include "core/data/model_reader.h"
#include "good_model.h"
#include "targets.h"

namespace palpate::fuzz {

/// A good model, changed: an input is the number of the model, then one change after the other. A change overwrites numbers,
/// gives an array another type, shape and size, says something else in an attribute, or takes an array or an attribute away.
[[nodiscard]] GoodModel changedModel(Bytes input);

/// Reads and checks a model as programs do. The source outlives its arrays. @throw LoadError  it is refused
ModelContents readAll(const ModelSource& source);

/// Lets a reader have it.
void fill(ArrayReader& reader, const GoodModel& model);

}  // namespace palpate::fuzz
