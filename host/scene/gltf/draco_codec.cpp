// SPDX-License-Identifier: Apache-2.0
// The module that decodes compressed meshes. Only this file knows Draco.
#include "host/scene/gltf/draco_codec.h"

#include <draco/compression/decode.h>

#include <memory>

namespace nearlight::core::gltf {
namespace {

constexpr int kMaxComponents = 16;

std::string read_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                           DracoMesh::Attribute& read) {
    read.components = attribute.num_components();
    if (read.components < 1 || read.components > kMaxComponents) {
        return "an attribute has " + std::to_string(read.components) + " numbers";
    }
    read.are_whole = draco::IsDataTypeIntegral(attribute.data_type()) && !attribute.normalized();
    read.numbers.reserve(std::size_t{mesh.num_points()} * static_cast<std::size_t>(read.components));
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        float values[kMaxComponents] = {};
        if (!attribute.ConvertValue<float>(attribute.mapped_index(point),
                                           static_cast<std::int8_t>(read.components), values)) {
            return "an attribute has numbers of an unknown type";
        }
        read.numbers.insert(read.numbers.end(), values, values + read.components);
    }
    return {};
}

std::string decode(std::span<const std::byte> bytes, DracoMesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
        return decoded.status().error_msg_string();
    }
    const std::unique_ptr<draco::Mesh> source = std::move(decoded).value();
    for (draco::FaceIndex face(0); face < source->num_faces(); ++face) {
        for (const draco::PointIndex& corner : source->face(face)) {
            mesh.corners.push_back(corner.value());
        }
    }
    for (int i = 0; i < source->num_attributes(); ++i) {
        const draco::PointAttribute& attribute = *source->attribute(i);
        const std::string failed = read_attribute(*source, attribute, mesh.attributes[attribute.unique_id()]);
        if (!failed.empty()) {
            return failed;
        }
    }
    return {};
}

}  // namespace
}  // namespace nearlight::core::gltf

extern "C" {
extern const nearlight::core::gltf::DracoCodec nearlight_draco_codec;
const nearlight::core::gltf::DracoCodec nearlight_draco_codec{nearlight::core::gltf::decode};
}
