// SPDX-License-Identifier: Apache-2.0
// A first look at the JSON of a glTF file, before anything is made of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace nearlight::core::gltf {

struct JsonSurvey {
    std::string fault{};                ///< where the JSON is broken, and how; empty if it is valid
    std::size_t depth = 0;              ///< how deep arrays and objects are nested
    std::vector<std::string> required;  ///< what `extensionsRequired` names
    std::vector<std::string> used;      ///< what `extensionsUsed` names
    bool is_version_1 = false;          ///< meshes, nodes or scenes have names in place of numbers
};

/// Reads the text once, in memory that does not grow with how deeply it is nested.
JsonSurvey survey_json(std::string_view text);

/// Where the bytes of a buffer come from.
struct BufferSource {
    std::string uri;           ///< of a file, or with the bytes in it; may be empty
    std::uint64_t length = 0;  ///< byteLength
    bool is_in_file = false;   ///< the first buffer of a .glb, without a URI
    bool is_stand_in = false;  ///< has no bytes, because what uses it is compressed elsewhere
};

/// An image that is in a buffer.
struct EmbeddedImage {
    std::size_t image = 0;
    int buffer_view = -1;  ///< −1: one that no file can have
};

/// The indices of a primitive, whose accessor has no buffer view: they are 0 but for sparse ones.
struct TakenIndices {
    std::size_t mesh = 0;
    std::size_t primitive = 0;
    int accessor = -1;
};

/// JSON of which tinygltf reads no buffers and files, and what was taken out of it.
struct LeanJson {
    std::string text;
    std::vector<BufferSource> buffers{};
    std::vector<EmbeddedImage> images{};
    std::vector<TakenIndices> indices{};
};

/// The kinds of compressed data that are decoded.
struct Decoders {
    bool draco = false;
    bool meshopt = false;
};

/// The JSON with one byte in place of each buffer, and with a name that no file has in place of the buffer
/// view of each image, which tinygltf looks up without a check. Primitives lose indices that have no buffer
/// view, which it refuses, for good if they are compressed. The JSON must be valid; `is_binary`: it is that
/// of a .glb.
LeanJson lean_json(std::string_view json, bool is_binary, Decoders decoders);

}  // namespace nearlight::core::gltf
