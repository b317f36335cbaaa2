// SPDX-License-Identifier: Apache-2.0
#include "core/record/record_writer.h"

#include <cerrno>
#include <cstring>

#include "core/record/crc32.h"
#include "core/record/layout.h"
#include "core/record/recorded_fields.h"
#include "core/record/tick_codec.h"

namespace palpate::record {
namespace {

Bytes bytesOf(const SessionFacts& facts) {
  Bytes bytes;
  put(bytes, facts.engine.project);
  put(bytes, facts.engine.answers);
  put(bytes, facts.model.bytes);
  put(bytes, facts.started_ns);
  forEachConfigField(facts.config, [&](const char*, const auto& field) { put(bytes, field); });
  const AllToolSettings settings = toolSettings(facts.config);
  forEachSetting(settings, [&](const char*, const double& field) { put(bytes, field); });
  return bytes;
}

}  // namespace

RecordWriter::RecordWriter(const std::filesystem::path& path, const SessionFacts& facts)
    : path_(path), file_(std::fopen(path.c_str(), "wb")), codec_(std::make_unique<TickCodec>()) {
  if (!file_) throw RecordError(path.string() + ": cannot be written: " + std::strerror(errno));
  writeAll(kMagic.data(), kMagic.size());
  writeAll(&kVersion, sizeof kVersion);
  writeBlock(kHeaderBlock, bytesOf(facts));
  flush();
}

RecordWriter::~RecordWriter() = default;

void RecordWriter::write(const RecordedTick& tick) {
  codec_->encode(tick, pending_);
  ++ticks_;
  if (pending_.size() < kFlushAt) return;
  writeBlock(kTicksBlock, pending_);
  pending_.clear();
}

void RecordWriter::flush() {
  if (!pending_.empty()) writeBlock(kTicksBlock, pending_);
  pending_.clear();
  if (std::fflush(file_.get()) != 0)
    throw RecordError(path_.string() + ": cannot be written: " + std::strerror(errno));
}

void RecordWriter::finish(std::uint64_t ticks_run) {
  flush();
  Bytes end;
  put(end, ticks_);
  put(end, ticks_run - ticks_);
  writeBlock(kEndBlock, end);
  flush();
}

void RecordWriter::writeBlock(std::uint32_t kind, const Bytes& content) {
  const BlockHead head{kind, static_cast<std::uint32_t>(content.size()), crc32(content)};
  writeAll(&head, sizeof head);
  writeAll(content.data(), content.size());
}

void RecordWriter::writeAll(const void* data, std::size_t size) {
  if (std::fwrite(data, 1, size, file_.get()) == size) return;
  throw RecordError(path_.string() + ": cannot be written: " + std::strerror(errno));
}

}  // namespace palpate::record
