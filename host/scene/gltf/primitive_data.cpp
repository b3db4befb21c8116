// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/primitive_data.h"

#include <numeric>

#include "host/scene/gltf/draco_codec.h"

namespace nearlight::core::gltf {
namespace {

/// Without the module, only files that do not require it come here, whose accessors hold the same numbers.
bool is_compressed(const tinygltf::Primitive& primitive) {
    return primitive.extensions.contains("KHR_draco_mesh_compression") && can_decode_draco();
}

}  // namespace

PrimitiveData::PrimitiveData(const GltfFile& file, const tinygltf::Primitive& primitive)
    : file_(file), primitive_(primitive), is_decoded_(is_compressed(primitive)) {
    if (is_decoded_) {
        decode_draco(file, primitive, decoded_, decoded_corners_);
    }
}

bool PrimitiveData::has(const std::string& attribute) const {
    return primitive_.attributes.contains(attribute) || decoded_.contains(attribute);
}

std::vector<float> PrimitiveData::read(const std::string& attribute, int components) const {
    AttributeData data = read(attribute);
    if (data.components != components) {
        file_.fail("the attribute " + attribute + " of a mesh does not have " + std::to_string(components) +
                   " numbers per element");
    }
    return std::move(data.numbers);
}

AttributeData PrimitiveData::read(const std::string& attribute) const {
    if (const auto found = decoded_.find(attribute); found != decoded_.end()) {
        return found->second;
    }
    const auto found = primitive_.attributes.find(attribute);
    if (found == primitive_.attributes.end()) {
        return {};
    }
    const tinygltf::Accessor& accessor = file_.at(file_.model.accessors, found->second, "accessor", "a mesh");
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    return {read_numbers(file_, found->second, components), components};
}

std::vector<uint> PrimitiveData::corners(std::size_t vertex_count) const {
    if (is_decoded_) {
        return decoded_corners_;
    }
    if (primitive_.indices >= 0) {
        return read_indices(file_, primitive_.indices);
    }
    std::vector<uint> corners(vertex_count);
    std::iota(corners.begin(), corners.end(), 0u);
    return corners;
}

int PrimitiveData::mode() const {
    return is_decoded_ ? TINYGLTF_MODE_TRIANGLES : primitive_.mode;
}

}  // namespace nearlight::core::gltf
