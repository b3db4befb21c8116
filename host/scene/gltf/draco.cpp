// SPDX-License-Identifier: Apache-2.0
// KHR_draco_mesh_compression.
#include <dlfcn.h>

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
        attributes[name] = {found->second.numbers, found->second.components};
    }
}

}  // namespace nearlight::core::gltf
