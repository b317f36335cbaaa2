// SPDX-License-Identifier: Apache-2.0
// core for a page, as WebAssembly: functions of plain numbers, and memory that the page reads and fills. One model and one
// organ at a time. What fails says so in words; nothing throws into the page. core/wasm/README.md
#include <emscripten.h>

#include <array>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/data/array_reader.h"
#include "core/data/model_reader.h"
#include "core/data/region_surfaces.h"
#include "core/model/meta_model.h"
#include "core/response/largest_stiffness.h"
#include "core/response/patch_response.h"
#include "core/tick/shown_surface.h"
#include "core/tick/step.h"

namespace palpate {

namespace {

/// A model that is felt.
struct Organ {
  MetaModel model;
  Workspace work;
  ShownSurface shown;
  FieldScratch scratch;
  std::vector<float> field;
  StepInput input{};
  StepResult result{};

  Organ(MetaModel loaded, const StepConfig& config)
      : model(std::move(loaded)),
        work(model, config),
        shown(model),
        scratch(model),
        field(3 * model.view().surfaceNodes(), 0.0F) {}
};

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

}  // extern "C"

}  // namespace palpate
