// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include "changed_model.h"
#include "core/data/load_error.h"
#include "core/data/model_answer.h"
#include "core/data/sealed_image.h"
#include "targets.h"

namespace palpate::fuzz {

namespace {

SealedImage sealed(const std::vector<std::uint8_t>& bytes) {
  const int file = memfd_create("model", 0);
  require(file >= 0 && pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
          "there is room for a file");
  SealedImage image(file, "model");
  close(file);
  return image;
}

/// The good models in one file, and what is said of each of them where nothing is wrong.
class File {
 public:
  File() : image_(sealed(describe())) {}
  [[nodiscard]] const SealedImage& image() const { return image_; }
  /// Of a good model, or of none.
  [[nodiscard]] std::string answer(std::size_t kind) const {
    return kind < kGoodModels ? answers_[kind] : std::string();
  }

 private:
  std::vector<std::uint8_t> describe() {
    std::vector<std::uint8_t> bytes;
    for (std::size_t kind = 0; kind < kGoodModels; ++kind) {
      const GoodModel model = goodModel(kind);
      ModelAnswer answer;
      for (const auto& [name, value] : model.attributes)
        if (const auto* text = std::get_if<std::string>(&value))
          answer.addText(name, *text);
        else
          answer.addNumbers(name, std::get<std::vector<double>>(value));
      for (const auto& [path, array] : model.arrays) {
        bytes.resize((bytes.size() + kArrayAlignment - 1) / kArrayAlignment * kArrayAlignment);
        answer.addArray(path, {array.type, array.shape}, bytes.size());
        bytes.insert(bytes.end(), array.bytes.begin(), array.bytes.end());
      }
      answers_[kind] = answer.whole();
    }
    return bytes;
  }

  std::array<std::string, kGoodModels> answers_;  // before the image, which describe() makes
  SealedImage image_;
};

// Each change puts some bytes in the place of some others.
std::string changed(std::string answer, Source& source) {
  while (!source.empty()) {
    const std::size_t at = std::min<std::size_t>(source.get<std::uint16_t>(), answer.size());
    const auto dropped = source.get<std::uint8_t>();
    answer.replace(at, dropped, source.text(source.get<std::uint8_t>()));
  }
  return answer;
}

}  // namespace

bool answer(Bytes input) {
  static const File file;
  Source source(input);
  const std::string kind_answer = file.answer(source.get<std::uint8_t>() % (kGoodModels + 1));
  try {
    readAll(AnsweredModel(file.image(), "model", changed(kind_answer, source)));
  } catch (const LoadError&) {
    return false;
  }
  return true;
}

}  // namespace palpate::fuzz
