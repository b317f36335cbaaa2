// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/tick/coupling_choice.h"
#include "palpate/rt/semaphore.h"
#include "palpate/rt/thread.h"
#include "palpate/server/engine.h"
#include "palpate/server/models_folder.h"
#include "palpate/server/organ_shape.h"

namespace palpate::server {

/// A model that is checked and mapped, and what costs time to find of it.
struct LoadedModel {
  std::string name;
  std::shared_ptr<const MetaModel> model;  ///< none: refused
  std::string refusal;                     ///< why
  std::unique_ptr<const OrganShape> shape;
  OrganStiffness organ{};
};

/// Loads and frees models beside the one that answers, on an ordinary thread that gives way to all others of the server. Its
/// checks, limits and refusals are those of the start; another process parses the file. Threads: the functions are called on
/// one. Real-time: no.
class ModelLoader {
 public:
  /// Starts the thread. @param[in] reader  the program that parses, for tests; empty: palpate-read-model. @throw ConfigError
  explicit ModelLoader(const std::filesystem::path& folder, std::filesystem::path reader = {});
  ~ModelLoader();
  ModelLoader(const ModelLoader&) = delete;
  ModelLoader& operator=(const ModelLoader&) = delete;

  /// Begins to load a file of the folder. One at a time: the next once poll() has given this one.
  void load(const std::string& name);
  /// @return the model that was asked for, or why it was refused, once that is known
  [[nodiscard]] std::optional<LoadedModel> poll();
  /// Frees what no other thread looks at any more.
  void discard(std::unique_ptr<Engine> engine);
  void discard(LoadedModel model);

 private:
  void run() noexcept;
  [[nodiscard]] LoadedModel read(const std::string& name) const;

  ModelsFolder folder_;
  std::filesystem::path reader_;
  std::mutex mutex_;  // the next four
  std::optional<std::string> wanted_;
  std::optional<LoadedModel> loaded_;
  std::vector<std::unique_ptr<Engine>> engines_;  // to be freed, like the next
  std::vector<LoadedModel> models_;
  std::atomic<bool> ending_{false};
  rt::Semaphore work_;
  std::optional<rt::Thread> thread_;  // last: it uses the rest
};

/// "model NAME: driven by displacement, 642 surface nodes, ...", for the log.
[[nodiscard]] std::string describe(const MetaModel& model, const std::string& name);

}  // namespace palpate::server
