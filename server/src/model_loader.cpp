// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/model_loader.h"

#include <spdlog/fmt/fmt.h>
#include <sys/resource.h>
#include <unistd.h>

#include <exception>
#include <new>
#include <utility>

#include "core/data/load_error.h"
#include "core/data/sealed_image.h"
#include "core/response/largest_stiffness.h"

namespace palpate::server {
namespace {

constexpr int kNice = 10;  // behind all other ordinary threads

std::shared_ptr<const SealedImage> copyOf(const ModelsFolder& folder, const std::string& name) {
  const int file = folder.open(name);
  try {
    auto image = std::make_shared<const SealedImage>(file, name);
    ::close(file);
    return image;
  } catch (...) {
    ::close(file);
    throw;
  }
}

}  // namespace

std::string describe(const MetaModel& model, const std::string& name) {
  const ModelView& view = model.view();
  return fmt::format(
      "model {}: driven by {}, {} surface nodes, {} contact positions, {} modes, {} coefficients, {:.1f} MB, "
      "id {}",
      name, toString(model.attributes().parameters), view.surfaceNodes(), view.positions(), view.modes(),
      model.functions().size(), 1e-6 * static_cast<double>(model.bytes()), model.id());
}

ModelLoader::ModelLoader(const std::filesystem::path& folder, std::filesystem::path reader)
    : folder_(folder), reader_(std::move(reader)) {
  thread_.emplace(rt::ThreadOptions{"models", 0, rt::RealtimePolicy::kOff, {}}, [this] { run(); });
}

ModelLoader::~ModelLoader() {
  ending_ = true;
  work_.post();
}

void ModelLoader::load(const std::string& name) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = name;
  }
  work_.post();
}

std::optional<LoadedModel> ModelLoader::poll() {
  const std::lock_guard lock(mutex_);
  return std::exchange(loaded_, std::nullopt);
}

void ModelLoader::discard(std::unique_ptr<Engine> engine) {
  {
    const std::lock_guard lock(mutex_);
    engines_.push_back(std::move(engine));
  }
  work_.post();
}

void ModelLoader::discard(LoadedModel model) {
  {
    const std::lock_guard lock(mutex_);
    models_.push_back(std::move(model));
  }
  work_.post();
}

void ModelLoader::run() noexcept {
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
  for (;;) {
    work_.wait();
    std::optional<std::string> wanted;
    std::vector<std::unique_ptr<Engine>> engines;  // freed at the end of this turn, outside of the lock
    std::vector<LoadedModel> models;
    {
      if (ending_) return;
      const std::lock_guard lock(mutex_);
      wanted.swap(wanted_);
      engines.swap(engines_);
      models.swap(models_);
    }
    if (!wanted) continue;
    LoadedModel loaded = read(*wanted);
    const std::lock_guard lock(mutex_);
    loaded_ = std::move(loaded);
  }
}

LoadedModel ModelLoader::read(const std::string& name) const {
  LoadedModel loaded;
  loaded.name = name;
  try {
    const auto image = copyOf(folder_, name);
    // Made in place: a model refers to its own parts.
    loaded.model.reset(
        new const MetaModel(MetaModel::load(image, name, {.program = reader_, .given_up = &ending_})));
    loaded.shape = std::make_unique<const OrganShape>(*loaded.model);
    loaded.organ = {loaded.model->attributes().E, largestStiffness(*loaded.model)};
  } catch (const std::bad_alloc&) {
    loaded.refusal = name + ": memory is short";
  } catch (const std::exception& error) {
    loaded.refusal = error.what();
  }
  if (!loaded.refusal.empty()) {
    loaded.shape.reset();
    loaded.model.reset();
  }
  return loaded;
}

}  // namespace palpate::server
