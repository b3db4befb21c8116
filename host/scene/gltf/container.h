// SPDX-License-Identifier: Apache-2.0
// The two forms of a glTF file: JSON alone (.gltf), or chunks (.glb).
#pragma once

#include <string_view>

#include "host/scene/gltf/gltf_file.h"

namespace nearlight::core::gltf {

struct FileChunks {
    std::string_view json{};
    std::string_view binary{};  ///< the bytes of the first buffer, if they are in the file itself
    bool is_binary = false;     ///< the file is a .glb
    bool is_version_1 = false;  ///< a .glb of glTF 1, whose chunks are not looked for
};

/// The parts of a file. Chunks of unknown types are left out [glTF 2.0, 4.4.3]. Calls fail() if a chunk is
/// cut short, or if the first one is not JSON.
FileChunks chunks_of(const GltfFile& file, std::string_view bytes);

}  // namespace nearlight::core::gltf
