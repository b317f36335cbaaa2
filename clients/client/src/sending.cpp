// SPDX-License-Identifier: Apache-2.0
#include "palpate/client/sending.h"

#include <pthread.h>

#include "palpate/client/error.h"
#include "palpate/idl/receive_threads.h"
#include "palpate/rt/scheduling.h"

namespace palpate::client {

SendingPriority::SendingPriority(std::span<const ToolClient* const> tools) {
  constexpr int kPriority = 60;
  constexpr int kReceivePriority = 65;
  for (const ToolClient* const tool : tools) {
    if (tool->waitForServer(std::chrono::seconds(5))) continue;
    const std::string mismatch = tool->mismatch();
    throw ClientError("the server takes no poses or sends no forces (waited 5 s)" +
                      (mismatch.empty() ? "" : ": " + mismatch));
  }
  (void)rt::raiseThreadsNamed(dds::kReceiveThreads, kReceivePriority);
  pthread_getschedparam(pthread_self(), &policy_, &parameters_);
  granted_ = rt::raiseThisThread(kPriority) == 0;
}

SendingPriority::~SendingPriority() {
  if (granted_) pthread_setschedparam(pthread_self(), policy_, &parameters_);
}

std::string leftOutText(const LeftOut& left_out, const StatusBoard& statuses) {
  if (left_out.count == 0) return {};
  const auto status = statuses.find(left_out.newest);
  return std::to_string(left_out.count) + " forces of another server were left out: " +
         (status ? describe(*status) : nameOf(left_out.newest)) + "\n";
}

}  // namespace palpate::client
