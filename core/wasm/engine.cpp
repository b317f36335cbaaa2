// SPDX-License-Identifier: Apache-2.0
// core for a page, as WebAssembly: functions of plain numbers, and memory that the page reads and fills. One model and one
// organ at a time. What fails says so in words; nothing throws into the page. core/wasm/README.md
#include <emscripten.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/base/status_flags.h"
#include "core/data/array_reader.h"
#include "core/data/model_digests.h"
#include "core/data/model_reader.h"
#include "core/response/largest_stiffness.h"
#include "core/response/patch_response.h"
#include "core/wasm/organ.h"

namespace palpate {

std::unique_ptr<Organ> organ;

namespace {

std::int64_t nanoseconds(double ms) {
  return static_cast<std::int64_t>(1e6 * ms);
}

/// Of the rest surface where the driven tool touches it, or nearest to it. @return unit, outward
Vec3 normalThere() {
  const Vec3 anchor = Eigen::Map<const Vec3>(organ->result.tools[0].anchor.data());
  return organ->model.surface().normal(organ->model.surface().closestPoint(anchor).s);
}

std::unique_ptr<ArrayReader> reader;
ModelContents contents;
std::string said;

ModelDigests digestsAt(const std::uint8_t* bytes) {
  ModelDigests digests;
  for (Digest* const digest : {&digests.provenance, &digests.content, &digests.certificate}) {
    std::copy_n(bytes, digest->bytes.size(), digest->bytes.begin());
    bytes += digest->bytes.size();
  }
  return digests;
}

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
  constexpr std::array kTypes{NumberType::kF64, NumberType::kF32, NumberType::kI16,        NumberType::kI32,
                              NumberType::kI64, NumberType::kU8,  NumberType::kRegionName, NumberType::kI8};
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

EMSCRIPTEN_KEEPALIVE void palpate_numbers(const char* name, const double* values, int count) {
  reader->addAttribute(name, std::vector<double>(values, values + count));
}

/// Room for an array. @param type  0 f64, 1 f32, 2 i16, 3 i32, 4 i64, 5 u8, 6 names of regions, 7 i8  @param shape  `rank` lengths
/// @return where its bytes belong; null without memory
EMSCRIPTEN_KEEPALIVE void* palpate_array(const char* path, int type, int rank, const double* shape,
                                         std::size_t bytes) {
  void* room = nullptr;
  (void)inWords([&] {
    room = reader->addArray(path, typeOf(type), std::vector<std::uint64_t>(shape, shape + rank), bytes);
  });
  return room;
}

/// All attributes and arrays are there: reads them, and notes what digests are to be computed of (sha256_page.cpp).
/// @return empty, or what is wrong, one sentence
EMSCRIPTEN_KEEPALIVE const char* palpate_read(const char* name) {
  return inWords([&] {
    organ.reset();
    contents = readModel(*reader, name);
    (void)digestsOf(contents);
  });
}

/// Checks what was read and makes the organ, which replaces the one before. @param digests  computed of it, one after the other
/// @return empty, or what is wrong, one sentence
EMSCRIPTEN_KEEPALIVE const char* palpate_load(const char* name, const std::uint8_t* digests,
                                              double tip_radius) {
  return inWords([&] {
    const std::unique_ptr<ArrayReader> from = std::move(reader);
    MetaModel model =
        MetaModel::of({from->memory(), static_cast<std::size_t>(from->bytes()), true},
                      std::exchange(contents, {}), digestsAt(digests), name, DimpleTable::kWhenTouched);
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

/// The page takes the tool, or takes it back while it lifts off. @param now_ms  of tick()'s clock
EMSCRIPTEN_KEEPALIVE void palpate_grab(double now_ms) {
  if (organ->follower)
    organ->follower->regrab(nanoseconds(now_ms));
  else
    organ->follower.emplace(nanoseconds(now_ms), organ->speed_limit);
}

/// Where the tool that the page has taken shall be, m. It comes there as a hand does (PoseFollower).
EMSCRIPTEN_KEEPALIVE void palpate_target(double x, double y, double z, double now_ms) {
  if (organ->follower) organ->follower->target({{x, y, z}}, nanoseconds(now_ms));
}

/// The tool lifts off and is gone.
EMSCRIPTEN_KEEPALIVE void palpate_release() {
  const Vec3 n = normalThere();
  if (organ->follower) organ->follower->release({{n.x(), n.y(), n.z()}});
}

/// A step with the tool that the page has taken. @return 0 there is none, 1 it has no place yet, 2 there is one
EMSCRIPTEN_KEEPALIVE int palpate_tick(double now_ms) {
  ToolInput& tool = organ->input.tools[0];
  tool.present = 0;
  if (organ->follower) {
    if (const std::optional<device::Point> tip = organ->follower->step(nanoseconds(now_ms))) {
      tool.present = 1;
      tool.position = *tip;
    }
    if (organ->follower->state() == device::PoseFollower::State::kOver) organ->follower.reset();
  }
  (void)palpate_step();
  if (!organ->follower) return 0;
  return tool.present == 1 ? 2 : 1;
}

/// -n.K n of the driven tool, N/m, along the rest surface's outward normal n; 0 when free.
EMSCRIPTEN_KEEPALIVE double palpate_stiffness() {
  const ToolResult& tool = organ->result.tools[0];
  if (tool.state == static_cast<std::uint32_t>(ContactState::kFree)) return 0.0;
  const Vec3 n = normalThere();
  return -n.dot(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(tool.stiffness.data()) * n);
}

}  // extern "C"

}  // namespace palpate
