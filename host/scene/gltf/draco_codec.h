// SPDX-License-Identifier: Apache-2.0
// The interface to Draco, which is in a module of its own (draco_codec.cpp): its shared library also holds
// another version of tinygltf, whose functions must not take the place of those that are linked here.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace nearlight::core::gltf {

/// A compressed mesh as numbers.
struct DracoMesh {
    struct Attribute {
        std::vector<float> numbers;
        int components = 0;
        bool are_whole = false;  ///< integers that stand for themselves
    };
    std::vector<unsigned int> corners;             ///< vertices of the corners of triangles
    std::map<unsigned int, Attribute> attributes;  ///< by their ids in the compressed mesh
};

/// What the module exports as `nearlight_draco_codec`.
struct DracoCodec {
    /// Decodes the bytes; returns the reason of a failure, or an empty string.
    std::string (*decode)(std::span<const std::byte> bytes, DracoMesh& mesh);
};

/// Whether the module is there. The first call loads it.
bool can_decode_draco();

}  // namespace nearlight::core::gltf
