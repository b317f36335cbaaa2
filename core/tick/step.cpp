// SPDX-License-Identifier: Apache-2.0
#include "core/tick/step.h"

#include "core/tick/stepper.h"

namespace palpate {

StepStatus stepForces(const MetaModel& model, Workspace& work, const StepInput& input,
                      StepResult& result) noexcept PALPATE_NONBLOCKING {
  return Stepper(model, work, input).run(result);
}

StepStatus step(const MetaModel& model, Workspace& work, const StepInput& input,
                StepResult& result) noexcept PALPATE_NONBLOCKING {
  const StepStatus status = stepForces(model, work, input, result);
  if (input.skip_surface == 0) (void)stepSurface(model, work);
  return status;
}

bool stepSurface(const MetaModel& model, Workspace& work) noexcept PALPATE_NONBLOCKING {
  return Stepper::showSurface(model, work);
}

}  // namespace palpate
