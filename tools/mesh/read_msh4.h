// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tools/mesh/byte_reader.h"
#include "tools/mesh/msh_element.h"
#include "tools/mesh/raw_mesh.h"

namespace palpate::mesh {

/// Physical groups of the model's entities: (dimension, tag) -> numbers.
using MshEntities = std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::int64_t>>;

/// The sections of version 4. The reader is at the line after the section's name, in binary
/// mode if the file is binary.
void readMsh4Entities(ByteReader& in, const MshFormat& format, MshEntities& entities);
void readMsh4Nodes(ByteReader& in, const MshFormat& format, RawMesh& mesh);
void readMsh4Elements(ByteReader& in, const MshFormat& format, const MshEntities& entities, RawMesh& mesh);

}  // namespace palpate::mesh
