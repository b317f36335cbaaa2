// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace palpate::server {

/// The folder whose model files clients may ask for. Whoever asks is not trusted: what is opened lies in the folder, whatever the
/// name says and whatever links there are. Threads: any. Real-time: no.
class ModelsFolder {
 public:
  /// Opens the folder; from here on it is this one, also if it is renamed. @throw ConfigError  it is no folder that can be opened
  explicit ModelsFolder(const std::filesystem::path& path);
  ModelsFolder(const ModelsFolder&) = delete;
  ModelsFolder& operator=(const ModelsFolder&) = delete;
  ~ModelsFolder();

  /// @return why a name cannot be one of a file in the folder; empty: it can
  [[nodiscard]] static std::string complaintAbout(const std::string& name);

  /// @param[in] name  relative to the folder, without ".."
  /// @return open for reading, the caller's to close
  /// @throw LoadError  what complaintAbout() says; there is no such file; a link leads out of the folder; the system cannot tell
  [[nodiscard]] int open(const std::string& name) const;

 private:
  int descriptor_;
};

}  // namespace palpate::server
