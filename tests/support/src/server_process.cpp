// SPDX-License-Identifier: Apache-2.0
#include "palpate/testing/server_process.h"

namespace palpate::testing {

ServerProcess::ServerProcess(const std::vector<std::string>& arguments, int log_fd)
    : process_("palpate-server", arguments, {.err = log_fd >= 0 ? log_fd : log_.descriptor()}) {}

}  // namespace palpate::testing
