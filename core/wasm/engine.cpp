// SPDX-License-Identifier: Apache-2.0
// core for a page, as WebAssembly: functions of plain numbers, and memory that the page reads and fills. One model and one
// organ at a time. What fails says so in words; nothing throws into the page. core/wasm/README.md
#include <emscripten.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/data/array_reader.h"
#include "core/data/model_reader.h"
#include "core/data/region_surfaces.h"
#include "core/devices/path/pose_follower.h"
#include "core/model/meta_model.h"
#include "core/response/largest_stiffness.h"
#include "core/response/patch_response.h"
#include "core/tick/shown_surface.h"
#include "core/tick/step.h"

namespace palpate {

namespace {

constexpr double kHandSpeed = 0.6;  // m/s, of a tool that a page drives

/// A model that is felt.
struct Organ {
  MetaModel model;
  Workspace work;
  ShownSurface shown;
  FieldScratch scratch;
  std::vector<float> field;
  StepInput input{};
  StepResult result{};
  AllToolSettings settings;
  double speed_limit;
  std::optional<device::PoseFollower> follower;  ///< of the tool that the page drives
  std::vector<std::uint8_t> accessible, clamped;
  std::vector<RegionSurface> regions;

  Organ(MetaModel loaded, const StepConfig& config)
      : model(std::move(loaded)),
        work(model, config),
        shown(model),
        scratch(model),
        field(3 * model.view().surfaceNodes(), 0.0F),
        settings(toolSettings(config)),
        speed_limit(std::min(kHandSpeed, 0.5 * config.speed_limit)),
        accessible(model.accessibleNodes()),
        clamped(model.clampedNodes()),
        regions(regionSurfaces(model.view())) {
    for (ToolSettings& tool : settings)
      if (tool.live.youngs_modulus == 0.0) tool.live.youngs_modulus = model.attributes().E;
  }
};

std::int64_t nanoseconds(double ms) {
  return static_cast<std::int64_t>(1e6 * ms);
}

/// Off the organ: along the force, and without one away from the nearest point.
device::Point outwardOf(const ToolInput& tool, const ToolResult& result) {
  const Vec3 force = Eigen::Map<const Vec3>(result.force.data());
  Vec3 way = force;
  if (force.norm() < 1e-6)
    way = Eigen::Map<const Vec3>(tool.position.data()) - Eigen::Map<const Vec3>(result.anchor.data());
  const double length = way.norm();
  if (!(length > 0.0)) return {{0.0, 0.0, 1.0}};
  return {{way.x() / length, way.y() / length, way.z() / length}};
}

std::unique_ptr<ArrayReader> reader;
std::unique_ptr<Organ> organ;
std::string said;

template <class Work>
const char* inWords(Work&& work) {
  said.clear();
  try {
    work();
  } catch (const std::bad_alloc&) {
    said = "the page has no memory left for this model";
  } catch (const std::exception& error) {
    said = error.what();
  }
  return said.c_str();
}

NumberType typeOf(int number) {
  constexpr std::array kTypes{NumberType::kF64, NumberType::kF32, NumberType::kI16,       NumberType::kI32,
                              NumberType::kI64, NumberType::kU8,  NumberType::kRegionName};
  return kTypes.at(static_cast<std::size_t>(number));
}

}  // namespace

extern "C" {

/// Begins a new model. @param name  how it is called in messages
EMSCRIPTEN_KEEPALIVE void palpate_begin(const char* name) {
  reader = std::make_unique<ArrayReader>(name);
}

EMSCRIPTEN_KEEPALIVE void palpate_text(const char* name, const char* text) {
  reader->addAttribute(name, std::string(text));
}

EMSCRIPTEN_KEEPALIVE void palpate_integer(const char* name, int value) {
  reader->addAttribute(name, value);
}

EMSCRIPTEN_KEEPALIVE void palpate_numbers(const char* name, const double* values, int count) {
  reader->addAttribute(name, std::vector<double>(values, values + count));
}

/// Room for an array. @param type  0 f64, 1 f32, 2 i16, 3 i32, 4 i64, 5 u8, 6 names of regions  @param shape  `rank` lengths
/// @return where its bytes belong; null without memory
EMSCRIPTEN_KEEPALIVE void* palpate_array(const char* path, int type, int rank, const double* shape,
                                         std::size_t bytes) {
  void* room = nullptr;
  (void)inWords([&] {
    room = reader->addArray(path, typeOf(type), std::vector<std::uint64_t>(shape, shape + rank), bytes);
  });
  return room;
}

/// All attributes and arrays are there: checks them and makes the organ, which replaces the one before.
/// @return empty, or what is wrong, one sentence
EMSCRIPTEN_KEEPALIVE const char* palpate_load(const char* name, double tip_radius) {
  return inWords([&] {
    organ.reset();
    const std::unique_ptr<ArrayReader> from = std::move(reader);
    ModelContents contents = readModel(*from, name);
    MetaModel model = MetaModel::of({from->memory(), static_cast<std::size_t>(from->bytes()), true},
                                    std::move(contents), name);
    StepConfig config;
    config.tip_radius = tip_radius;

    config.organ_stiffness = largestStiffness(model);
    organ = std::make_unique<Organ>(std::move(model), config);
  });
}

/// What names the model, hexadecimal.
EMSCRIPTEN_KEEPALIVE const char* palpate_id() {
  said = organ->model.id();
  return said.c_str();
}

EMSCRIPTEN_KEEPALIVE int palpate_nodes() {
  return static_cast<int>(organ->model.view().surfaceNodes());
}

/// respond() at a triangle's point. @param s  three barycentric weights  @param d  m
/// @param[out] out  force (3), stiffness (9, row-major), displacement (3), parameter (3)  @return ResponseStatus
EMSCRIPTEN_KEEPALIVE int palpate_respond(int triangle, const double* s, const double* d, double* out) {
  Response response;
  const ResponseStatus status =
      respond(organ->model, {triangle, {s[0], s[1], s[2]}}, {d[0], d[1], d[2]}, response);
  Eigen::Map<Vec3>{out} = response.force;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{out + 3} = response.stiffness;
  Eigen::Map<Vec3>{out + 12} = response.displacement;
  Eigen::Map<Vec3>{out + 15} = response.parameter;
  return static_cast<int>(status);
}

/// evaluateField() of one tool that imposes d. @return [nodes][3] floats, m
EMSCRIPTEN_KEEPALIVE const float* palpate_field(int triangle, const double* s, const double* d) {
  evaluateField(organ->model, {triangle, {s[0], s[1], s[2]}}, {d[0], d[1], d[2]}, organ->scratch,
                organ->field);
  return organ->field.data();
}

/// The next tick's StepInput, to be filled in, and the last one's StepResult: laid out as on every machine.
EMSCRIPTEN_KEEPALIVE StepInput* palpate_input() {
  return &organ->input;
}
EMSCRIPTEN_KEEPALIVE const StepResult* palpate_result() {
  return &organ->result;
}
EMSCRIPTEN_KEEPALIVE int palpate_input_bytes() {
  return sizeof(StepInput);
}
EMSCRIPTEN_KEEPALIVE int palpate_result_bytes() {
  return sizeof(StepResult);
}

/// step() with palpate_input(). @return StepStatus
EMSCRIPTEN_KEEPALIVE int palpate_step() {
  organ->input.field_overflowed = organ->shown.overflowed() ? 1 : 0;
  return static_cast<int>(step(organ->model, organ->work, organ->input, organ->result));
}

/// The surface after the last step. @return [nodes][3] floats, m, or null when it is the one of before
EMSCRIPTEN_KEEPALIVE const float* palpate_surface() {
  return organ->shown.show(organ->work.surface()) ? organ->shown.displacement().data() : nullptr;
}

/// The rest surface: [nodes][3] doubles, m; triangles; [nodes] bytes.
EMSCRIPTEN_KEEPALIVE const double* palpate_positions() {
  return organ->model.view().surface_positions.data();
}
EMSCRIPTEN_KEEPALIVE int palpate_triangle_count() {
  return static_cast<int>(organ->model.view().triangles());
}
EMSCRIPTEN_KEEPALIVE const std::int32_t* palpate_triangles() {
  return organ->model.view().surface_triangles.data();
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* palpate_accessible() {
  return organ->accessible.data();
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* palpate_clamped() {
  return organ->clamped.data();
}

/// Where regions end inside: how many, and of each its name, E in Pa, nodes and triangles.
EMSCRIPTEN_KEEPALIVE int palpate_regions() {
  return static_cast<int>(organ->regions.size());
}
EMSCRIPTEN_KEEPALIVE const char* palpate_region_name(int region) {
  said = textOf(organ->model.view().region_name[static_cast<std::size_t>(region)]);
  return said.c_str();
}
EMSCRIPTEN_KEEPALIVE double palpate_region_modulus(int region) {
  return organ->model.view().region_E[static_cast<std::size_t>(region)];
}
EMSCRIPTEN_KEEPALIVE int palpate_region_nodes(int region) {
  return static_cast<int>(organ->regions[static_cast<std::size_t>(region)].positions.size() / 3);
}
EMSCRIPTEN_KEEPALIVE const double* palpate_region_positions(int region) {
  return organ->regions[static_cast<std::size_t>(region)].positions.data();
}
EMSCRIPTEN_KEEPALIVE int palpate_region_triangle_count(int region) {
  return static_cast<int>(organ->regions[static_cast<std::size_t>(region)].triangles.size() / 3);
}
EMSCRIPTEN_KEEPALIVE const std::uint32_t* palpate_region_triangles(int region) {
  return organ->regions[static_cast<std::size_t>(region)].triangles.data();
}

/// E of the model, Pa; and what is asked for now: E, friction; force limit, N.
EMSCRIPTEN_KEEPALIVE double palpate_model_modulus() {
  return organ->model.attributes().E;
}
EMSCRIPTEN_KEEPALIVE double palpate_modulus() {
  return organ->settings[0].live.youngs_modulus;
}
EMSCRIPTEN_KEEPALIVE double palpate_friction() {
  return organ->settings[0].live.friction;
}
EMSCRIPTEN_KEEPALIVE double palpate_force_limit() {
  return organ->settings[0].live.force_limit;
}

/// New values for the organ's E and the tool's friction. @return empty, or which is out of its range
EMSCRIPTEN_KEEPALIVE const char* palpate_set(double youngs_modulus, double friction) {
  return inWords([&] {
    AllToolSettings wanted = organ->settings;
    for (ToolSettings& tool : wanted) {
      tool.live.youngs_modulus = youngs_modulus;
      tool.live.friction = friction;
      if (const auto complaint = firstComplaint(tool)) throw std::invalid_argument(complaint->sentence());
    }
    organ->settings = organ->input.settings = wanted;
    organ->input.has_settings = 1;
  });
}

/// Where the tool that the page drives shall be, m. It comes there as a hand does (PoseFollower). @param now_ms  of tick()'s clock
EMSCRIPTEN_KEEPALIVE void palpate_target(double x, double y, double z, double now_ms) {
  if (!organ->follower) organ->follower.emplace(nanoseconds(now_ms), organ->speed_limit);
  organ->follower->regrab(nanoseconds(now_ms));
  organ->follower->target({{x, y, z}}, nanoseconds(now_ms));
}

/// The tool lifts off and is gone.
EMSCRIPTEN_KEEPALIVE void palpate_release() {
  if (organ->follower) organ->follower->release(outwardOf(organ->input.tools[0], organ->result.tools[0]));
}

/// A step with the tool that the page drives. @return 1 while there is one
EMSCRIPTEN_KEEPALIVE int palpate_tick(double now_ms) {
  ToolInput& tool = organ->input.tools[0];
  if (organ->follower) {
    const std::optional<device::Point> tip = organ->follower->step(nanoseconds(now_ms));
    tool.present = tip ? 1 : 0;
    if (tip) tool.position = *tip;
    if (organ->follower->state() == device::PoseFollower::State::kOver) organ->follower.reset();
  }
  if (!organ->follower) tool.present = 0;
  (void)palpate_step();
  return organ->follower ? 1 : 0;
}

}  // extern "C"

}  // namespace palpate
