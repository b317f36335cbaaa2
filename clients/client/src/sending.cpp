// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/sending.h"

#include "palpate/client/error.h"
#include "palpate/idl/receive_threads.h"
#include "palpate/rt/scheduling.h"

namespace palpate::client {

bool prepareToSend(const ToolClient& tool) {
  constexpr int kPriority = 60;
  constexpr int kReceivePriority = 65;
  if (!tool.waitForServer(std::chrono::seconds(5)))
    throw ClientError("the server takes no poses or sends no forces (waited 5 s)");
  (void)rt::raiseThreadsNamed(dds::kReceiveThreads, kReceivePriority);
  return rt::raiseThisThread(kPriority) == 0;
}

}  // namespace palpate::client
