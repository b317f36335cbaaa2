// SPDX-License-Identifier: Apache-2.0
// Model files that are right.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <tuple>

#include "../load_case.h"
#include "core/data/sealed_image.h"
#include "core/model/field_evaluation.h"
#include "core/model/meta_model.h"
#include "tools/modelfile/pack_fields.h"

namespace palpate::testing {

using modelfile::ModelData;

TEST(Load, GivesBackAForceOfTheHighestDegree) {
  const TemporaryFile file("degree-8.h5");
  const ModelData d = syntheticModel({.subdivisions = 1, .order = 4, .force_order = 8, .modes = 2});
  modelfile::writeModel(file.path(), d);
  const MetaModel model = MetaModel::load(file.path());
  EXPECT_EQ(model.attributes().order, 4);
  EXPECT_EQ(model.attributes().force_order, 8);
  EXPECT_EQ(model.view().contact_force.size(), 3 * 164 * d.contact_node.size());
  EXPECT_TRUE(sameBits(d.contact_force, model.view().contact_force));
}

TEST(Load, GivesBackEveryBitThatWasWritten) {
  const TemporaryFile file("round-trip.h5");
  const ModelData& d = goodData();
  modelfile::writeModel(file.path(), d);
  const MetaModel model = MetaModel::load(file.path());
  const ModelView& v = model.view();
  EXPECT_TRUE(sameBits(d.surface_positions, v.surface_positions));
  EXPECT_TRUE(sameBits(d.surface_triangles, v.surface_triangles));
  EXPECT_TRUE(sameBits(d.surface_mesh_tag, v.surface_mesh_tag));
  EXPECT_TRUE(sameBits(d.position_of_node, v.position_of_node));
  EXPECT_TRUE(sameBits(d.contact_node, v.contact_node));
  EXPECT_TRUE(sameBits(d.contact_accessible, v.contact_accessible));
  EXPECT_TRUE(sameBits(d.contact_force, v.contact_force));
  EXPECT_TRUE(sameBits(d.contact_stiffness, v.contact_stiffness));
  EXPECT_TRUE(sameBits(d.contact_domain_radius, v.contact_domain_radius));
  EXPECT_TRUE(sameBits(d.contact_series_radius, v.contact_series_radius));
  const modelfile::PackedFields fields = modelfile::packFields(d);
  EXPECT_TRUE(sameBits(fields.X.whole, v.modes_X));
  EXPECT_TRUE(sameBits(fields.X.scale, v.modes_X_scale));
  EXPECT_TRUE(sameBits(fields.Y.whole, v.modes_Y));
  EXPECT_TRUE(sameBits(fields.Y.scale, v.modes_Y_scale));
  EXPECT_TRUE(sameBits(d.near_offset, v.near_offset));
  EXPECT_TRUE(sameBits(d.near_node, v.near_node));
  EXPECT_TRUE(sameBits(fields.near.whole, v.near_field));
  EXPECT_TRUE(sameBits(fields.near.scale, v.near_scale));
  EXPECT_TRUE(sameBits(d.green_node, v.green_node));
  EXPECT_TRUE(sameBits(fields.green_Y.whole, v.green_Y));
  EXPECT_TRUE(sameBits(fields.green_Y.scale, v.green_Y_scale));
  EXPECT_TRUE(sameBits(d.green_offset, v.green_offset));
  EXPECT_TRUE(sameBits(d.green_near_node, v.green_near_node));
  EXPECT_TRUE(sameBits(fields.green_near.whole, v.green_near));
  EXPECT_TRUE(sameBits(fields.green_near.scale, v.green_near_scale));
  EXPECT_TRUE(sameBits(d.edge_offset, v.edge_offset));
  EXPECT_TRUE(sameBits(d.edge_node, v.edge_node));
  EXPECT_TRUE(sameBits(fields.edges.whole, v.edge_field));
  EXPECT_TRUE(sameBits(fields.edges.scale, v.edge_scale));
  EXPECT_FALSE(v.edge_node.empty());
  EXPECT_TRUE(sameBits(d.mesh_nodes, v.mesh_nodes));
  EXPECT_TRUE(sameBits(d.mesh_tetrahedra, v.mesh_tetrahedra));
  EXPECT_TRUE(sameBits(d.mesh_node_tag, v.mesh_node_tag));
  EXPECT_TRUE(sameBits(d.mesh_tetrahedron_tag, v.mesh_tetrahedron_tag));
  EXPECT_TRUE(sameBits(d.mesh_fixed, v.mesh_fixed));
  EXPECT_TRUE(sameBits(d.mesh_surface_node, v.mesh_surface_node));
  const ModelAttributes &a = d.attributes, &b = model.attributes();
  EXPECT_EQ(std::tie(a.law, a.provenance, a.E, a.nu, a.order, a.patch_radius, a.near_radius,
                     a.reference_displacement, a.rounded_triangles),
            std::tie(b.law, b.provenance, b.E, b.nu, b.order, b.patch_radius, b.near_radius,
                     b.reference_displacement, b.rounded_triangles));
  EXPECT_EQ(model.bytes(), std::filesystem::file_size(file.path()));
}

TEST(Load, DividesTheSurfaceAsOftenAsTheFileAsks) {
  ModelData d = goodData();
  d.attributes.rounded_triangles = 1;
  const TemporaryFile few("few.h5"), many("many.h5");
  modelfile::writeModel(few.path(), d);
  modelfile::writeModel(many.path(), goodData());
  EXPECT_EQ(MetaModel::load(few.path()).contactSurface().levels(), 1);
  EXPECT_GT(MetaModel::load(many.path()).contactSurface().levels(), 1);
}

TEST(Load, TakesAModelWithoutModesAndNearField) {
  ModelData d = goodData();
  d.modes_X.clear();
  d.modes_Y.clear();
  d.near_node.clear();
  d.near_field.clear();
  d.green_Y.clear();
  d.green_near_node.clear();
  d.green_near.clear();
  d.green_node.resize(d.surface_mesh_tag.size());  // without fixed nodes all may be loaded
  std::iota(d.green_node.begin(), d.green_node.end(), 0);
  d.green_offset.assign(d.green_node.size() + 1, 0);
  std::fill(d.near_offset.begin(), d.near_offset.end(), 0);
  d.mesh_fixed.clear();
  const TemporaryFile file("response-only.h5");
  modelfile::writeModel(file.path(), d);
  EXPECT_EQ(complaint(file.path()), "");
  const MetaModel model = MetaModel::load(file.path());
  EXPECT_EQ(model.view().modes(), 0U);
  std::vector<float> u(3 * model.view().surfaceNodes(), 7.0F);
  FieldScratch scratch(model);
  const FieldSource source{{0, {0.2, 0.3, 0.5}}, Vec3(0.0, 0.0, 1e-3), 1.0};
  evaluateField(model, std::span(&source, 1), scratch, u);
  EXPECT_EQ(u, std::vector<float>(u.size(), 0.0F));
}

TEST(Load, TakesAModelWhoseEdgesAddNothing) {
  ModelData d = goodData();
  d.edge_order = 0;
  d.edge_offset.clear(), d.edge_node.clear(), d.edge_field.clear();
  const TemporaryFile file("without-edges.h5"), with("with-edges.h5");
  modelfile::writeModel(file.path(), d);
  modelfile::writeModel(with.path(), goodData());
  const MetaModel model = MetaModel::load(file.path());
  EXPECT_EQ(model.edgeCoefficients(), 0U);
  EXPECT_NE(model.id(), MetaModel::load(with.path()).id());
}

TEST(Load, LongProvenanceComesBack) {
  ModelData d = goodData();
  d.attributes.provenance = "{\"case\": \"" + std::string(300000, 'x') + "\"}";
  const TemporaryFile file("long.h5");
  modelfile::writeModel(file.path(), d);
  EXPECT_EQ(MetaModel::load(file.path()).attributes().provenance, d.attributes.provenance);
}

TEST(Load, ModelOutlivesItsFile) {
  const TemporaryFile file("gone.h5");
  modelfile::writeModel(file.path(), goodData());
  const MetaModel model = MetaModel::load(file.path());
  std::filesystem::resize_file(file.path(), 0);
  EXPECT_TRUE(sameBits(modelfile::packFields(goodData()).near.whole, model.view().near_field));
}

TEST(Load, LeavesNoHandleBehind) {
  const TemporaryFile good("handles.h5"), bad("handles-bad.h5");
  modelfile::writeModel(good.path(), goodData());
  ModelData d = goodData();
  d.attributes.nu = 0.7;
  modelfile::writeModel(bad.path(), d);
  for (int i = 0; i < 3; ++i) complaint(good.path()), complaint(bad.path());
  EXPECT_EQ(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL), 0);
}

TEST(Load, SealedCopyCannotBeWritten) {
  const TemporaryFile file("sealed.h5");
  modelfile::writeModel(file.path(), goodData());
  const SealedImage image(file.path());
  EXPECT_LT(::write(image.descriptor(), "x", 1), 0);
  EXPECT_LT(::ftruncate(image.descriptor(), 0), 0);
}

}  // namespace palpate::testing
