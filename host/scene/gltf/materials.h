// SPDX-License-Identifier: Apache-2.0
// Converts glTF's metallic-roughness materials to those of the scene.
#pragma once

#include <map>
#include <utility>

#include "host/image/image.h"
#include "host/scene/gltf/gltf_file.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core::gltf {

/// The index of a material of the scene, and the set of texture coordinates that it uses.
struct PlacedMaterial {
    uint index = 0;
    int texture_set = 0;
};

/// Makes each material when a mesh first asks for it: a principled one for metals and bases that reflect,
/// diffuse for bases that hardly do, glass where light is transmitted. Masks, blends and normal maps lie
/// around it. What is left out or replaced by its mean is noted.
class MaterialMaker {
  public:
    MaterialMaker(const GltfFile& file, Scene& scene, NoteSink& notes)
        : file_(file), scene_(scene), notes_(notes), textures_(scene, notes) {}

    /// The material with the index in the file; −1 stands for a mesh without a material, which is grey.
    PlacedMaterial material(int index);

  private:
    struct Surface;
    [[nodiscard]] Surface surface_of(const tinygltf::Material& source);
    [[nodiscard]] uint make(const tinygltf::Material& source);
    [[nodiscard]] uint add_opaque(const Surface& surface);
    [[nodiscard]] uint add_glass(const Surface& surface);
    uint add(const Material& material);
    [[nodiscard]] Parameter emission_of(const tinygltf::Material& source);
    [[nodiscard]] Parameter opacity_of(const tinygltf::Material& source);
    void remark_what_is_left_out(const tinygltf::Material& source);
    void approximate(const std::string& what);
    [[nodiscard]] Parameter textured_by(const tinygltf::TextureInfo& info, Vec3 value, const TexelRule& rule);
    int load_image(const tinygltf::Image& image, const TexelRule& rule);

    const GltfFile& file_;
    Scene& scene_;
    NoteSink& notes_;
    TextureLoader textures_;
    std::map<int, PlacedMaterial> made_;
    std::map<std::pair<int, TexelRule>, int> images_;  ///< index into Scene::images, or −1
};

}  // namespace nearlight::core::gltf
