// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "changed_model.h"
#include "core/data/load_error.h"
#include "core/data/model_answer.h"
#include "core/data/model_content.h"
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

/// What is said of a model, and where in it the places of arrays stand.
struct Answer {
  std::string text;
  std::vector<std::size_t> places;
};

/// The good models in one file, and what is said of each of them where nothing is wrong.
class File {
 public:
  File() : image_(sealed(describe())) {}
  [[nodiscard]] const SealedImage& image() const { return image_; }
  /// Of a good model, or of none.
  [[nodiscard]] Answer answer(std::size_t kind) const {
    return kind < kGoodModels ? answers_[kind] : Answer();
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
        answers_[kind].places.push_back(answer.whole().size() - 1 - sizeof(std::uint64_t));
        bytes.insert(bytes.end(), array.bytes.begin(), array.bytes.end());
      }
      answers_[kind].text = answer.whole();
    }
    return bytes;
  }

  std::array<Answer, kGoodModels> answers_;  // before the image, which describe() makes
  SealedImage image_;
};

// First, arrays are moved; then each change puts some bytes in the place of some others.
std::string changed(Answer answer, Source& source) {
  std::string& text = answer.text;
  for (int moved = source.get<std::uint8_t>() % 4; moved > 0 && !answer.places.empty(); --moved) {
    const std::size_t array = source.get<std::uint8_t>() % answer.places.size();
    const std::uint64_t place = source.get<std::uint16_t>() * kArrayAlignment;
    std::memcpy(text.data() + answer.places[array], &place, sizeof place);
  }
  while (!source.empty()) {
    const std::size_t at = std::min<std::size_t>(source.get<std::uint16_t>(), text.size());
    const auto dropped = source.get<std::uint8_t>();
    text.replace(at, dropped, source.text(source.get<std::uint8_t>()));
  }
  return text;
}

template <class T>
std::span<const std::byte> bytesOf(std::span<const T> array) {
  return std::as_bytes(array);
}
std::span<const std::byte> bytesOf(const WholeNumbers& array) {
  return array.asBytes();
}

// Arrays lie in the file whole and apart from each other, or are copies.
void look(const ModelContents& contents, std::span<const std::byte> file) {
  std::map<std::ptrdiff_t, std::ptrdiff_t> places;  // begin, end
  forEachDataset(contents.attributes, contents.view, [&](const auto&, const auto& array) {
    const std::span<const std::byte> bytes = bytesOf(array);
    const std::less<> before;
    if (bytes.empty() || before(bytes.data(), file.data()) ||
        !before(bytes.data(), file.data() + file.size()))
      return;
    const std::ptrdiff_t begin = bytes.data() - file.data(), size = std::ssize(bytes);
    require(size <= std::ssize(file) - begin, "an array lies in the file");
    require(places.emplace(begin, begin + size).second, "no arrays begin in one place");
  });
  std::ptrdiff_t free = 0;
  for (const auto& [begin, end] : places) {
    require(free <= begin, "arrays lie apart from each other");
    free = end;
  }
}

}  // namespace

bool answer(Bytes input) {
  static const File file;
  Source source(input);
  const Answer good = file.answer(source.get<std::uint8_t>() % (kGoodModels + 1));
  try {
    const AnsweredModel model(file.image(), "model", changed(good, source));
    look(readAll(model), file.image().bytes());
  } catch (const LoadError&) {
    return false;
  }
  return true;
}

}  // namespace palpate::fuzz
