// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/record/byte_stream.h"
#include "core/record/recording.h"

namespace palpate::record {

/// Turns ticks into bytes and back; keeps the tick before, because what it repeats is left out. One for each direction
/// of one file. The layout is in docs/recording_file.md.
class TickCodec {
 public:
  void encode(const RecordedTick& tick, Bytes& out);
  /// @throw RecordError
  void decode(ByteSource& in, RecordedTick& tick);

 private:
  void encodeTool(const RecordedTick& tick, std::size_t tool, Bytes& out);
  void decodeTool(ByteSource& in, std::size_t tool);

  RecordedTick last_{};
};

}  // namespace palpate::record
