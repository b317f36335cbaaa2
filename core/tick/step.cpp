// SPDX-License-Identifier: Apache-2.0
#include "core/tick/step.h"

#include "core/tick/stepper.h"

namespace palpate {

StepStatus step(const MetaModel& model, Workspace& work, const StepInput& input,
                StepResult& result) noexcept PALPATE_NONBLOCKING {
  return Stepper(model, work, input).run(result);
}

}  // namespace palpate
