// SPDX-License-Identifier: Apache-2.0
#include "core/record/record_reader.h"

#include <algorithm>
#include <fstream>

#include "core/record/crc32.h"
#include "core/record/layout.h"
#include "core/record/recorded_fields.h"
#include "core/record/tick_codec.h"

namespace palpate::record {

/// A block's content, and how far it was read.
class RecordReader::Block {
 public:
  explicit Block(Bytes content) : content_(std::move(content)), source_(content_) {}
  [[nodiscard]] ByteSource& source() noexcept { return source_; }

 private:
  Bytes content_;
  ByteSource source_;
};

namespace {

std::unique_ptr<std::istream> opened(const std::filesystem::path& path) {
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!std::filesystem::is_regular_file(path) || !*file)
    throw RecordError(path.string() + ": cannot be read as a file");
  return file;
}

}  // namespace

RecordReader::RecordReader(const std::filesystem::path& path) : RecordReader(path, opened(path)) {}

RecordReader::RecordReader(const std::filesystem::path& path, std::unique_ptr<std::istream> file)
    : path_(path), file_(std::move(file)), codec_(std::make_unique<TickCodec>()) {
  std::array<std::uint8_t, kMagic.size()> magic{};
  std::uint32_t version = 0;
  file_->read(reinterpret_cast<char*>(magic.data()), static_cast<std::streamsize>(magic.size()));
  if (!*file_ || magic != kMagic) throw RecordError(path.string() + ": is no recording of palpate-server");
  offset_ = magic.size();
  read(&version, sizeof version);
  if (version != kVersion)
    throw RecordError(path.string() + ": version " + std::to_string(version) +
                      " of the recording; this program reads version " + std::to_string(kVersion) +
                      ": record the session again");
  if (readBlock() != kHeaderBlock) refuse("expected the header");
  try {
    readFacts();
  } catch (const RecordError& error) {
    refuse(std::string("header: ") + error.what());
  }
}

RecordReader::~RecordReader() = default;

void RecordReader::readFacts() {
  ByteSource& in = block_->source();
  in.get(facts_.engine.project);
  in.get(facts_.engine.answers);
  in.get(facts_.model.bytes);
  in.get(facts_.started_ns);
  forEachConfigField(facts_.config, [&](const char*, auto& field) { in.get(field); });
  AllToolSettings settings;
  forEachSetting(settings, [&](const char*, double& field) { in.get(field); });
  std::copy(settings.begin(), settings.end(), facts_.config.own.begin());
  if (!in.empty()) throw RecordError("longer than expected");
  block_.reset();
}

bool RecordReader::next(RecordedTick& tick) {
  while (!block_ || block_->source().empty()) {
    const std::uint32_t kind = readBlock();
    if (kind == kEndBlock) {
      readEnd();
      return false;
    }
    if (kind != kTicksBlock) refuse("a block of unknown kind " + std::to_string(kind));
  }
  try {
    codec_->decode(block_->source(), tick);
  } catch (const RecordError& error) {
    refuse(error.what());
  }
  if (last_index_ && tick.index <= *last_index_)
    refuse("tick " + std::to_string(tick.index) + " after tick " + std::to_string(*last_index_));
  last_index_ = tick.index;
  ++ticks_;
  return true;
}

void RecordReader::readEnd() {
  try {
    block_->source().get(end_.ticks);
    block_->source().get(end_.missing);
  } catch (const RecordError& error) {
    refuse(error.what());
  }
  if (end_.ticks != ticks_)
    refuse("the end tells of " + std::to_string(end_.ticks) + " ticks, " + std::to_string(ticks_) +
           " were found");
  if (!block_->source().empty() || file_->peek() != std::istream::traits_type::eof())
    refuse("something follows the end");
}

std::uint32_t RecordReader::readBlock() {
  block_begin_ = offset_;
  BlockHead head;
  read(&head, sizeof head);
  if (head.size > kLargestBlock) refuse("a block of " + std::to_string(head.size) + " bytes");
  Bytes content(head.size);
  read(content.data(), content.size());
  if (crc32(content) != head.crc) refuse("damaged, the checksum is another");
  block_ = std::make_unique<Block>(std::move(content));
  return head.kind;
}

void RecordReader::read(void* to, std::size_t size) {
  file_->read(static_cast<char*>(to), static_cast<std::streamsize>(size));
  if (static_cast<std::size_t>(file_->gcount()) != size) refuseTruncated();
  offset_ += size;
}

void RecordReader::refuse(const std::string& text) const {
  throw RecordError(path_.string() + ": block at byte " + std::to_string(block_begin_) + ": " + text);
}

void RecordReader::refuseTruncated() const {
  throw TruncatedError(path_.string() + ": truncated after byte " + std::to_string(offset_) + ": " +
                       std::to_string(ticks_) + " ticks and no end");
}

}  // namespace palpate::record
