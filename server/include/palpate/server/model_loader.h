// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/data/try_in_child.h"
#include "core/tick/coupling_choice.h"
#include "palpate/rt/semaphore.h"
#include "palpate/rt/thread.h"
#include "palpate/server/engine.h"
#include "palpate/server/models_folder.h"
#include "palpate/server/organ_shape.h"

namespace palpate::server {

/// The first argument of this program where it is started to look at a model (tryInProgram()).
inline constexpr const char* kTrialArgument = "--try-model";

/// A model that is checked and mapped, and what costs time to find of it.
struct LoadedModel {
  std::string name;
  std::shared_ptr<const MetaModel> model;  ///< none: refused
  std::string refusal;                     ///< why
  std::unique_ptr<const OrganShape> shape;
  OrganStiffness organ{};
};

/// Loads and frees models beside the one that answers, on an ordinary thread that gives way to all others of the server. Its
/// checks, limits and refusals are those of the start; HDF5 looks at the file in another process, which is started without a
/// fork() of this one. Threads: the functions are called on one. Real-time: no.
class ModelLoader {
 public:
  /// Where HDF5 has a first look at a copy. @throw LoadError, also once the patience's `given_up` is set: the loader ends
  using Trial =
      std::function<void(const SealedImage& image, const std::string& name, const Patience& patience)>;

  /// Starts the thread. @param[in] trial  tryInProgram() of kTrialArgument, or another for tests. @throw ConfigError
  explicit ModelLoader(const std::filesystem::path& folder, Trial trial = &ModelLoader::tryInThisProgram);
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
  static void tryInThisProgram(const SealedImage& image, const std::string& name, const Patience& patience);
  void run() noexcept;
  [[nodiscard]] LoadedModel read(const std::string& name) const;

  ModelsFolder folder_;
  Trial trial_;
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
