// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/model/meta_model.h"
#include "tools/examine/query/answer.h"
#include "tools/examine/query/full_solution.h"

namespace palpate::query {

/// What the model answers to one of several tools.
struct ToolAnswer {
  Vec3 own = Vec3::Zero();  ///< what it imposes by itself, d_own, m
  Answer together;          ///< with the others; the field is its own part
  Answer alone;             ///< to d, as if there were no other tool
};

/// What the model answers to tools that press together.
struct JointAnswer {
  std::vector<ToolAnswer> tools;
  std::vector<float> field;       ///< u of all tools, [Ns][3], m
  std::vector<float> superposed;  ///< u of the tools alone added up, [Ns][3], m
};

/// The tool that --tool2 asks for. @param text  "NODE:dx,dy,dz", the node's number in the mesh file, d in m
/// @throw program::UsageError naming option and text, or the node as in anchorAtNode()
[[nodiscard]] Touch parseTouch(const MetaModel& model, const std::string& option, const std::string& text);

/// @throw program::UsageError naming what is wrong: more than kMaxTools tools, two at one place, one that is not accessible
void checkTouches(const MetaModel& model, std::span<const Touch> touches);

/// f and u of tools that press together, coupled by ownDisplacements(), and superposed without.   docs/design.md, Contact
/// @param touches  passed by checkTouches()
[[nodiscard]] JointAnswer askTogether(const MetaModel& model, std::span<const Touch> touches);

/// How far it is off from Newton with all patches prescribed.
struct JointErrors {
  std::vector<double> force;  ///< of each tool, |f - f_Newton| / |f_Newton|
  FieldErrors field;          ///< over the largest |d| that was asked for
};

[[nodiscard]] JointErrors coupledErrors(const JointAnswer& answer, std::span<const Touch> touches,
                                        const FullSolution& truth, const Organ& organ);

/// The same of the answers of the tools alone, added up.
[[nodiscard]] JointErrors superposedErrors(const JointAnswer& answer, std::span<const Touch> touches,
                                           const FullSolution& truth, const Organ& organ);

}  // namespace palpate::query
