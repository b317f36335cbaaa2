// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "changed_model.h"
#include "core/data/load_error.h"
#include "core/data/model_digests.h"
#include "core/data/model_reader.h"
#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "core/response/largest_stiffness.h"
#include "core/response/patch_response.h"
#include "targets.h"

namespace palpate::fuzz {

namespace {

// As if somebody had written these changes into the file with all digests.
MetaModel organOf(const ArrayReader& reader, DimpleTable dimple) {
  ModelContents contents = readModel(reader, "model");
  const ModelDigests digests = digestsOf(contents);
  contents.stored = {digests.content.hex(), digests.provenance.hex(), digests.certificate.hex(),
                     digests.content.hex()};
  return MetaModel::of({reader.memory(), reader.bytes(), true}, std::move(contents), digests, "model",
                       dimple);
}

// What ticks ask of it, everywhere.
void press(const MetaModel& model) {
  FieldScratch scratch(model);
  std::vector<float> field(3 * model.view().surfaceNodes());
  const auto triangles = static_cast<std::int32_t>(std::min<std::size_t>(model.view().contactTriangles(), 8));
  for (std::int32_t t = 0; t < triangles; ++t)
    for (const Vec3& d : {Vec3(0.0, 0.0, -1e-3), Vec3(0.1, 0.0, 0.2)}) {
      const ContactPoint s{t, {0.5, 0.25, 0.25}};
      Response response;
      (void)PatchResponse(model, s).at(d, response);
      const std::array<FieldSource, 1> source{FieldSource{s, response.parameter}};
      evaluateField(model, source, scratch, field);
      const std::array<ContactPoint, 2> points{s, ContactPoint{0, {0.0, 0.0, 1.0}}};
      std::array<Vec3, 2> there;
      fieldAt(model, source, scratch, points, there);
    }
  (void)model.surface().closestPoint(Vec3(0.02, 0.03, 0.5));
  (void)largestStiffness(model);
}

}  // namespace

bool organ(Bytes input) {
  ArrayReader reader("model");
  fill(reader, changedModel(input));
  try {
    press(organOf(reader, input.size() % 2 == 0 ? DimpleTable::kAtLoad : DimpleTable::kWhenTouched));
  } catch (const LoadError&) {
    return false;
  }
  return true;
}

}  // namespace palpate::fuzz
