// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "palpate/client/surface.h"

namespace palpate::report {

/// Writes the surface, displaced, with the node fields `displacement` (m), `accessible` and `mesh_tag`, as
/// ASCII for ParaView: .vtu (XML) or .vtk (legacy), by the file's extension.
/// @param[in] displacement  3 Ns, m, node-interleaved
/// @throw client::ClientError for another extension, another size, or a file that cannot be written
void writeSurface(const std::filesystem::path& path, const client::Surface& surface,
                  const std::vector<float>& displacement);

/// @throw client::ClientError unless the extension is one of those that writeSurface() knows
void checkSurfacePath(const std::filesystem::path& path);

}  // namespace palpate::report
