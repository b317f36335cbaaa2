// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace palpate {

class SealedImage;

/// The process that parses a model file, so that this one does not: palpate-read-model (core/reader).
struct ReaderProcess {
  std::filesystem::path program{};         ///< empty: that of this installation, or of this build
  std::chrono::milliseconds most{30'000};  ///< it is waited for, three times its processor time, then killed
  const std::atomic<bool>* given_up{nullptr};  ///< set: nobody wants to know it; looked at ten times a second
};

/// The process's program as a program finds it: by its place in the installation, else beside itself, else in `bin` beside its folder.
/// @param[in] self  where the program is  @return none: self is not absolute
[[nodiscard]] std::optional<std::filesystem::path> readerOf(const std::filesystem::path& self);

/// Starts the process on a copy and hears what it says, without a fork(): nothing of this process is copied, and no thread of
/// it waits but the one that asks. It inherits no descriptor, variable or blocked signal.
/// @param[in] name  of the file in messages
/// @return its answer (model_answer.h), of which nothing is checked. Real-time: no.
/// @throw LoadError  it cannot be started, crashed, was killed, ran out of its limits or of time, or says too much
[[nodiscard]] std::string askReader(const SealedImage& image, const std::string& name,
                                    const ReaderProcess& process = {});

}  // namespace palpate
