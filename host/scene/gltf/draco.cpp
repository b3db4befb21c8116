// SPDX-License-Identifier: Apache-2.0
// KHR_draco_mesh_compression, decoded by Google's library. Only this file knows it.
#include "host/scene/gltf/primitive_data.h"

#ifdef NEARLIGHT_DRACO

#include <draco/compression/decode.h>

#include <memory>

namespace nearlight::core::gltf {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";

AttributeData decoded_numbers(const GltfFile& file, const draco::Mesh& mesh,
                              const draco::PointAttribute& attribute) {
    const int components = attribute.num_components();
    if (components < 1 || components > 4) {
        file.fail("a compressed mesh has an attribute of " + std::to_string(components) + " numbers");
    }
    AttributeData data{{}, components};
    data.numbers.reserve(std::size_t{mesh.num_points()} * static_cast<std::size_t>(components));
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        float values[4] = {0, 0, 0, 0};
        if (!attribute.ConvertValue<float>(attribute.mapped_index(point),
                                           static_cast<std::int8_t>(components), values)) {
            file.fail("a compressed mesh has numbers of an unknown type");
        }
        data.numbers.insert(data.numbers.end(), values, values + components);
    }
    return data;
}

std::unique_ptr<draco::Mesh> decode(const GltfFile& file, std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
        file.fail(std::string("a compressed mesh cannot be decoded: ") + decoded.status().error_msg());
    }
    return std::move(decoded).value();
}

}  // namespace

void decode_draco(const GltfFile& file, const tinygltf::Primitive& primitive,
                  std::map<std::string, AttributeData>& attributes, std::vector<uint>& corners) {
    const int view = index_of(primitive.extensions, kDraco, "bufferView", -1);
    const std::unique_ptr<draco::Mesh> mesh = decode(file, bytes_of(file, view));
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face) {
        for (const draco::PointIndex& corner : mesh->face(face)) {
            corners.push_back(corner.value());
        }
    }
    const tinygltf::Value& named = primitive.extensions.at(kDraco).Get("attributes");
    for (const std::string& name : named.Keys()) {
        const tinygltf::Value& id = named.Get(name);
        const draco::PointAttribute* const attribute =
            id.IsInt() && id.GetNumberAsInt() >= 0
                ? mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id.GetNumberAsInt()))
                : nullptr;
        if (attribute == nullptr) {
            file.fail("a compressed mesh lacks its attribute " + name);
        }
        attributes[name] = decoded_numbers(file, *mesh, *attribute);
    }
}

}  // namespace nearlight::core::gltf

#else

namespace nearlight::core::gltf {

void decode_draco(const GltfFile& file, const tinygltf::Primitive&, std::map<std::string, AttributeData>&,
                  std::vector<uint>&) {
    file.fail("has compressed meshes, but this build lacks Draco (Debian's libdraco-dev)");
}

}  // namespace nearlight::core::gltf

#endif
