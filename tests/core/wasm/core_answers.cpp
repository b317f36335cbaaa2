// SPDX-License-Identifier: Apache-2.0
// core_answers MODEL FILE [SESSION]: what core answers here, for compare.mjs to hold WebAssembly to. 1000 random touches with
// their fields, and a session of ticks: a recorded one, or a tool that presses and slides. Little-endian, without gaps:
//   i32 touches, i32 nodes, i32 ticks, i32 sizeof(StepInput), i32 sizeof(StepResult), i32 0, f64 us of a step (median)
//   per touch: i32 triangle, i32 status, f64 barycentric[3], f64 d[3], f64 answer[18], f32 u[nodes][3]
//   per tick: StepInput, StepResult
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <random>
#include <vector>

#include "core/model/meta_model.h"
#include "core/record/record_reader.h"
#include "core/response/largest_stiffness.h"
#include "core/response/patch_response.h"
#include "core/tick/step.h"

namespace {

using namespace palpate;

class Writer {
 public:
  explicit Writer(const char* path) : file_(path, std::ios::binary) {}
  template <typename T>
  void put(const T& value) {
    put(&value, sizeof value);
  }
  void put(const void* bytes, std::size_t size) {
    file_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  }
  [[nodiscard]] bool good() const { return file_.good(); }

 private:
  std::ofstream file_;
};

void writeTouches(const MetaModel& model, int count, Writer& out) {
  std::mt19937 random(18);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  FieldScratch scratch(model);
  std::vector<float> u(3 * model.view().surfaceNodes());
  for (int i = 0; i < count;) {
    const auto triangle =
        static_cast<std::int32_t>(random() % static_cast<unsigned>(model.surface().triangles()));
    if (!model.surface().reachable(triangle)) continue;
    ++i;
    const double a = std::sqrt(0.5 + 0.5 * uniform(random)), b = 0.5 + 0.5 * uniform(random);
    const ContactPoint s{triangle, {1.0 - a, a * (1.0 - b), a * b}};
    const Vec3 d = 0.008 * Vec3(uniform(random), uniform(random), uniform(random));
    Response response;
    const auto status = static_cast<std::int32_t>(respond(model, s, d, response));
    evaluateField(model, s, d, scratch, u);
    out.put(triangle), out.put(status), out.put(s.barycentric), out.put(d);
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> stiffness = response.stiffness;
    out.put(response.force), out.put(stiffness), out.put(response.displacement), out.put(response.parameter);
    out.put(u.data(), u.size() * sizeof(float));
  }
}

/// 4 s: to the surface, 4 mm in, along it in circles of 6 mm, and off.
std::vector<StepInput> pressAndSlide(const MetaModel& model, double tip_radius) {
  std::int32_t triangle = 0;
  while (!model.surface().reachable(triangle)) ++triangle;
  const ContactPoint s{triangle, {0.4, 0.3, 0.3}};
  const Vec3 n = model.surface().normal(s), X = model.surface().position(s);
  const Vec3 along = n.unitOrthogonal(), across = n.cross(along);
  std::vector<StepInput> ticks;
  for (int i = 0; i < 4000; ++i) {
    const double t = 1e-3 * i, turn = 2.0 * M_PI * std::max(0.0, t - 1.0) / 2.0;
    const double depth =
        0.007 * std::sin(std::min(1.0, t) * M_PI / 2.0) - (t > 3.0 ? 0.012 * (t - 3.0) : 0.0);
    const Vec3 tip = X + (tip_radius + 0.003 - depth) * n +
                     0.003 * (std::sin(turn) * along + (1.0 - std::cos(turn)) * across);
    StepInput input;
    input.tools[0].present = 1;
    input.tools[0].position = {tip.x(), tip.y(), tip.z()};
    ticks.push_back(input);
  }
  return ticks;
}

std::vector<StepInput> recorded(const char* path) {
  record::RecordReader reader(path);
  std::vector<StepInput> ticks;
  for (record::RecordedTick tick; reader.next(tick);) ticks.push_back(tick.input);
  return ticks;
}

double medianUs(std::vector<double> seconds) {
  std::nth_element(seconds.begin(), seconds.begin() + std::ptrdiff_t(seconds.size() / 2), seconds.end());
  return 1e6 * seconds[seconds.size() / 2];
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) return std::fprintf(stderr, "core_answers MODEL FILE [SESSION]\n"), 2;
  constexpr int kTouches = 1000;
  try {
    const MetaModel model = MetaModel::load(arguments[1]);
    StepConfig config;
    config.organ_stiffness = largestStiffness(model);
    const std::vector<StepInput> inputs =
        count > 3 ? recorded(arguments[3]) : pressAndSlide(model, config.tip_radius);
    Workspace work(model, config);
    std::vector<StepResult> results(inputs.size());
    std::vector<double> seconds;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      (void)step(model, work, inputs[i], results[i]);
      seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    Writer out(arguments[2]);
    for (const std::size_t number : {std::size_t{kTouches}, model.view().surfaceNodes(), inputs.size(),
                                     sizeof(StepInput), sizeof(StepResult), std::size_t{0}})
      out.put(static_cast<std::int32_t>(number));
    out.put(medianUs(seconds));
    writeTouches(model, kTouches, out);
    for (std::size_t i = 0; i < inputs.size(); ++i) out.put(inputs[i]), out.put(results[i]);
    return out.good() ? 0 : 1;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "core_answers: %s\n", error.what()), 1;
  }
}
