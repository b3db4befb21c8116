// SPDX-License-Identifier: Apache-2.0
// The buffers of a glTF file. They are read here, because tinygltf refuses those that are longer than they
// need to be [glTF 2.0, 3.6.1.1], and takes a plus sign in the name of a file for a blank.
#pragma once

#include <string_view>
#include <vector>

#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/json_survey.h"

namespace nearlight::core::gltf {

/// Decodes the bytes of a data URI of any kind. Returns false if it is no data URI, or not in base64.
bool decode_data_uri(const std::string& uri, std::vector<unsigned char>& bytes);

/// Gives the model's buffers their bytes: as many as `byteLength` says. `binary` has those that are in the
/// file itself. Buffers that stand in for others stay empty. Calls fail() if one is missing, unreadable or
/// too short.
void read_buffers(GltfFile& file, std::vector<BufferSource> sources, std::string_view binary);

}  // namespace nearlight::core::gltf
