// SPDX-License-Identifier: Apache-2.0
#include "tools/examine/query/batch.h"

#include <array>
#include <charconv>

#include "core/base/length.h"
#include "tools/examine/query/place.h"
#include "tools/examine/query/query_error.h"
#include "tools/program/numbers.h"

namespace palpate::query {

namespace {

/// One line of values, parted by commas.
class Line {
 public:
  void add(std::string_view word) { (text_ += text_.empty() ? "" : ",") += word; }
  void add(double number) {
    std::array<char, 32> digits{};
    const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    add(std::string_view(digits.data(), end));
  }
  template <class Vector>
  void addAll(const Vector& v) {
    for (const double number : {v[0], v[1], v[2]}) add(number);
  }
  [[nodiscard]] std::string ended() const { return text_ + '\n'; }

 private:
  std::string text_;
};

std::string lineOf(const BatchAnswer& one) {
  Line line;
  line.addAll(one.asked.at.numbers);
  line.addAll(one.asked.displacement.numbers);
  line.addAll(one.answer.response.force);
  line.add(toString(one.answer.status));
  line.add(one.anchor.distance.value_or(0.0));
  line.add(one.answer.response.domain_radius);
  line.add(one.clamped() ? "yes" : "no");
  line.addAll(one.answer.response.displacement);
  return line.ended();
}

BatchAnswer answerTo(const MetaModel& model, const TouchRow& touch) {
  try {
    const Anchor anchor = anchorOf(model, touch.at);
    const Vec3 d = displacementOf(model, touch.displacement);
    return {touch, anchor, d, askForce(model, anchor.s, {Parameters::kDisplacement, d})};
  } catch (const program::ValueError& error) {  // the fault of a file, not of the command line
    throw QueryError(error.what());
  }
}

}  // namespace

bool BatchAnswer::clamped() const {
  constexpr double kRounding = 1e-9;
  return answer.status == ResponseStatus::kBeyond &&
         lengthOf(answer.response.displacement - d) > kRounding * lengthOf(d);
}

std::vector<BatchAnswer> answersTo(const MetaModel& model, std::span<const TouchRow> touches) {
  std::vector<BatchAnswer> answers;
  for (const TouchRow& touch : touches) answers.push_back(answerTo(model, touch));
  return answers;
}

std::string batchColumns() {
  return "at_x,at_y,at_z,displacement_x,displacement_y,displacement_z,force_x_N,force_y_N,force_z_N,status,"
         "distance_m,domain_radius_m,clamped,used_x_m,used_y_m,used_z_m";
}

std::string batchText(std::span<const BatchAnswer> answers) {
  std::string text = batchColumns() + '\n';
  for (const BatchAnswer& one : answers) text += lineOf(one);
  return text;
}

}  // namespace palpate::query
