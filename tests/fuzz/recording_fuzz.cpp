// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "core/record/crc32.h"
#include "core/record/layout.h"
#include "core/record/record_reader.h"
#include "core/record/tick_codec.h"
#include "targets.h"

namespace palpate::fuzz {

bool recording(Bytes input) {
  record::RecordedTick tick;
  record::Bytes once, twice;
  record::TickCodec encoder, decoder, encoder_again;
  try {
    record::RecordReader reader(
        "session.rec", std::make_unique<std::istringstream>(std::string(input.begin(), input.end())));
    while (reader.next(tick)) encoder.encode(tick, once);
    require(reader.end().ticks == reader.ticks(), "the end counts the ticks");
    record::ByteSource source(once);
    while (!source.empty()) {
      decoder.decode(source, tick);
      encoder_again.encode(tick, twice);
    }
  } catch (const record::RecordError&) {
    return false;
  }
  require(once == twice, "what was read is written, and read, the same");
  return true;
}

void mendRecording(std::span<std::uint8_t> input) {
  constexpr std::size_t kStart = record::kMagic.size() + sizeof record::kVersion;
  if (input.size() < kStart) return;
  input = input.subspan(kStart);
  record::BlockHead head;
  while (input.size() >= sizeof head) {
    std::memcpy(&head, input.data(), sizeof head);
    head.size = static_cast<std::uint32_t>(std::min<std::size_t>(head.size, input.size() - sizeof head));
    head.crc = record::crc32(input.subspan(sizeof head, head.size));
    std::memcpy(input.data(), &head, sizeof head);
    input = input.subspan(sizeof head + head.size);
  }
}

}  // namespace palpate::fuzz
