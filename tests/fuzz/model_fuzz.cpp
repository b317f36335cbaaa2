// SPDX-License-Identifier: Apache-2.0
#include "changed_model.h"
#include "core/data/load_error.h"
#include "core/data/model_checks.h"
#include "core/data/model_content.h"
#include "targets.h"

namespace palpate::fuzz {

ModelContents readAll(const ModelSource& source) {
  ModelContents contents = readModel(source, "model");
  checkContents(contents.attributes, contents.view, "model");
  (void)contentDigest(contents.attributes, contents.view);  // looks at every byte
  const ModelView& v = contents.view;
  require(v.positions() > 0 && v.places() * kStiffnessNumbers == v.contact_stiffness.size(),
          "places are whole");
  require(v.surface_positions.size() == 3 * v.surfaceNodes(), "each node has a place");
  for (const std::int32_t node : v.surface_triangles)
    require(node >= 0 && static_cast<std::size_t>(node) < v.surfaceNodes(), "corners are nodes");
  return contents;
}

bool model(Bytes input) {
  ArrayReader reader("model");
  fill(reader, changedModel(input));
  try {
    (void)readAll(reader);
  } catch (const LoadError&) {
    return false;
  }
  return true;
}

}  // namespace palpate::fuzz
