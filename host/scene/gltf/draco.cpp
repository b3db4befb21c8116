// SPDX-License-Identifier: Apache-2.0
// KHR_draco_mesh_compression.
#include <dlfcn.h>

#include <algorithm>
#include <cmath>

#include "host/scene/gltf/draco_codec.h"
#include "host/scene/gltf/primitive_data.h"

namespace nearlight::core::gltf {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kDracoModule = "nearlight-draco.so";  // found by the run path, as that of images is

/// The module's functions; null if it is not there. The first call loads it.
const DracoCodec* draco_codec() {
    static const auto* const codec = [] {
        void* const module = dlopen(kDracoModule, RTLD_LAZY | RTLD_LOCAL);
        return static_cast<const DracoCodec*>(module == nullptr ? nullptr
                                                                : dlsym(module, "nearlight_draco_codec"));
    }();
    return codec;
}

/// Many encoders leave it to the accessor to say that whole numbers stand for those up to 1; some store these
/// as floats.
void scale_whole_numbers(const GltfFile& file, const tinygltf::Primitive& primitive, const std::string& name,
                         DracoMesh::Attribute& attribute) {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) {
        return;
    }
    const tinygltf::Accessor& accessor = file.at(file.model.accessors, found->second, "accessor", name);
    const int type = accessor.componentType;
    const float most = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 255.0f
                       : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 65535.0f
                       : type == TINYGLTF_COMPONENT_TYPE_BYTE           ? 127.0f
                       : type == TINYGLTF_COMPONENT_TYPE_SHORT          ? 32767.0f
                                                                        : 1.0f;
    const bool are_whole = attribute.are_whole || std::ranges::any_of(attribute.numbers, [](float number) {
                               return std::abs(number) > 1.0f;
                           });
    if (!accessor.normalized || !are_whole) {
        return;
    }
    for (float& number : attribute.numbers) {
        number = std::max(number / most, -1.0f);
    }
}

}  // namespace

bool can_decode_draco() {
    return draco_codec() != nullptr;
}

void decode_draco(const GltfFile& file, const tinygltf::Primitive& primitive,
                  std::map<std::string, AttributeData>& attributes, std::vector<uint>& corners) {
    const std::span<const std::byte> bytes =
        bytes_of(file, index_of(primitive.extensions, kDraco, "bufferView", -1));
    DracoMesh mesh;
    if (const std::string failed = draco_codec()->decode(bytes, mesh); !failed.empty()) {
        file.fail("a compressed mesh cannot be decoded: " + failed);
    }
    corners = std::move(mesh.corners);
    const tinygltf::ExtensionMap members{{kDraco, primitive.extensions.at(kDraco).Get("attributes")}};
    for (const std::string& name : members.at(kDraco).Keys()) {
        const int id = index_of(members, kDraco, name.c_str(), -1);
        const auto found = mesh.attributes.find(static_cast<unsigned int>(id));
        if (found == mesh.attributes.end()) {
            file.fail("a compressed mesh lacks its attribute " + name);
        }
        scale_whole_numbers(file, primitive, name, found->second);
        attributes[name] = {found->second.numbers, found->second.components};
    }
}

}  // namespace nearlight::core::gltf
