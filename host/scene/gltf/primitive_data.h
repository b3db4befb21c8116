// SPDX-License-Identifier: Apache-2.0
// The numbers of a mesh primitive, from accessors or from KHR_draco_mesh_compression.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "host/scene/gltf/gltf_file.h"

namespace nearlight::core::gltf {

/// Numbers of one attribute, `components` a vertex.
struct AttributeData {
    std::vector<float> numbers;
    int components = 0;
};

class PrimitiveData {
  public:
    /// Decodes the primitive if it is compressed. Calls fail() if that is impossible.
    PrimitiveData(const GltfFile& file, const tinygltf::Primitive& primitive);

    [[nodiscard]] bool has(const std::string& attribute) const;
    /// The attribute with the given number of components. Calls fail() if it has another, or if it is broken.
    [[nodiscard]] std::vector<float> read(const std::string& attribute, int components) const;
    /// The attribute with as many components as it has; empty if there is no such attribute.
    [[nodiscard]] AttributeData read(const std::string& attribute) const;
    /// The vertices of the corners of triangles, strips or fans.
    [[nodiscard]] std::vector<uint> corners(std::size_t vertex_count) const;
    [[nodiscard]] int mode() const;

  private:
    const GltfFile& file_;
    const tinygltf::Primitive& primitive_;
    bool is_decoded_ = false;
    std::map<std::string, AttributeData> decoded_;
    std::vector<uint> decoded_corners_;
};

/// What KHR_draco_mesh_compression holds: attributes by name, and corners of triangles. Calls fail() if it is
/// broken. The module must be there.
void decode_draco(const GltfFile& file, const tinygltf::Primitive& primitive,
                  std::map<std::string, AttributeData>& attributes, std::vector<uint>& corners);

}  // namespace nearlight::core::gltf
