// SPDX-License-Identifier: Apache-2.0
// Converts glTF's metallic-roughness materials to those of the scene.
#pragma once

#include <map>
#include <optional>

#include "host/image/image.h"
#include "host/scene/gltf/gltf_file.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core::gltf {

/// The index of a material of the scene, and the set of texture coordinates that it uses.
struct PlacedMaterial {
    uint index = 0;
    int texture_set = 0;
};

/// Makes each material when a mesh first asks for it. A dielectric becomes a Lambertian base under a coat, a
/// metal a rough conductor, and a transmitting surface glass. Textures of anything but colour are replaced by
/// their means or left out, with a note.
class MaterialMaker {
  public:
    MaterialMaker(const GltfFile& file, Scene& scene, NoteSink& notes)
        : file_(file), scene_(scene), notes_(notes), textures_(scene, notes) {}

    /// The material with the index in the file; −1 stands for a mesh without a material, which is grey.
    PlacedMaterial material(int index);

  private:
    struct Surface;
    [[nodiscard]] Surface surface_of(const tinygltf::Material& source);
    [[nodiscard]] Material make(const tinygltf::Material& source);
    [[nodiscard]] Material make_base(const tinygltf::Material& source, const Surface& surface, bool has_coat);
    [[nodiscard]] Material make_metal(const tinygltf::Material& source, const Surface& surface);
    [[nodiscard]] Vec3 emission_of(const tinygltf::Material& source);
    void remark_what_is_left_out(const tinygltf::Material& source);
    void approximate(const std::string& what);
    [[nodiscard]] const tinygltf::Image* image_of(const tinygltf::TextureInfo& info) const;
    int add_texture(const tinygltf::TextureInfo& info);
    int load_colors(const tinygltf::Image& image);
    std::optional<Vec3> mean_of(const tinygltf::TextureInfo& info);

    const GltfFile& file_;
    Scene& scene_;
    NoteSink& notes_;
    TextureLoader textures_;
    std::map<int, PlacedMaterial> made_;
    std::map<const tinygltf::Image*, int> colors_;                 ///< index into Scene::images, or −1
    std::map<const tinygltf::Image*, std::optional<Vec3>> means_;  ///< means of the file's numbers
};

}  // namespace nearlight::core::gltf
