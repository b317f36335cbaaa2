// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace palpate {

/// Does something in a child process that may take 10 s of processor time and, beside what this one has, 64 MiB and eight
/// times the file's size of addresses: numbers of 8 bits may be wanted in 64. What crashes or runs away there is not done here.
/// @param[in] name  of the file in messages  @param[in] bytes  size of the file
/// @param[in] work  gives the same result when it is done again here
/// @throw LoadError  as `work` threw it in the child, or the child crashed, ran out of its limits or cannot be started
void tryInChild(const std::string& name, std::size_t bytes, const std::function<void()>& work);

}  // namespace palpate
