// SPDX-License-Identifier: Apache-2.0
// Textures of glTF materials: images, samplers, transforms and sets of texture coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "host/scene/gltf/gltf_file.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core::gltf {

/// Which TEXCOORD_n of a mesh are the first and the second texture coordinates of its vertices, as textures
/// ask for them; −1: none does.
struct TextureSets {
    int first = -1;
    int second = -1;
};

/// The set that a texture asks for: n of TEXCOORD_n. Calls fail() if it is negative.
int texture_set_of(const GltfFile& file, const tinygltf::TextureInfo& info);

/// Where u and v of a texture with KHR_texture_transform grow, in the directions in which those of the mesh
/// do: unit vectors, perpendicular to each other.
struct TextureAxes {
    std::array<float, 2> u{1, 0};
    std::array<float, 2> v{0, 1};

    /// Whether they are neither those of the mesh nor turned by right angles.
    [[nodiscard]] bool are_oblique() const { return std::min(std::abs(u[0]), std::abs(u[1])) > 1e-4f; }
};
TextureAxes texture_axes(const tinygltf::TextureInfo& info);

/// What normal and occlusion textures have in common with all others.
template <typename Info>
tinygltf::TextureInfo plain_info(const Info& info) {
    tinygltf::TextureInfo plain;
    plain.index = info.index;
    plain.texCoord = info.texCoord;
    plain.extensions = info.extensions;
    return plain;
}

class TextureMaker {
  public:
    TextureMaker(const GltfFile& file, Scene& scene, NoteSink& notes)
        : file_(file), scene_(scene), notes_(notes), loader_(scene, notes) {
        loader_.expect(shown_images());
    }

    /// A parameter of the texture's numbers times `value`; `value` alone if there is no texture or the value
    /// is 0, and half of it, with a note, if the texture cannot be read. `flags` and `cutoff` are those of
    /// Texture.
    Parameter textured_by(const tinygltf::TextureInfo& info, Vec3 value, const TexelRule& rule,
                          const TextureSets& sets, uint flags = 0, float cutoff = 0.0f);
    /// A parameter of the colours of vertices times `value`.
    Parameter vertex_color(Vec3 value);
    /// A parameter of the number that vertices have as the first of their second texture coordinates, in
    /// [0, 1]. Above a cutoff that is not 0 it counts as 1, below as 0.
    Parameter vertex_number(float cutoff);
    /// The mean of a parameter over its texture.
    [[nodiscard]] Vec3 mean(const Parameter& parameter) const;
    /// Calls visit() with what the parameter is at each texel of its image, or once if it has none.
    void visit_texels(const Parameter& parameter, const std::function<void(Vec3)>& visit) const;
    /// Whether both textures show the same image at the same places of a surface.
    [[nodiscard]] bool show_same(const tinygltf::TextureInfo& a, const tinygltf::TextureInfo& b);

  private:
    [[nodiscard]] std::vector<ImageSource> shown_images() const;
    [[nodiscard]] bool can_read(int image);
    /// The index of the texture's image: in the format WebP, unless it cannot be read and there is another
    /// one; −1 if it has none.
    [[nodiscard]] int readable_image_of(const tinygltf::Texture& texture);
    [[nodiscard]] int image_of(const tinygltf::Texture& texture);
    void place(const tinygltf::TextureInfo& info, const tinygltf::Texture& source, Texture& texture) const;
    int load_image(const tinygltf::Image& image, const TexelRule& rule);

    const GltfFile& file_;
    Scene& scene_;
    NoteSink& notes_;
    TextureLoader loader_;
    std::map<std::pair<int, TexelRule>, int> images_;  ///< index into Scene::images, or −1
    std::map<int, bool> readable_;                     ///< whether images of the kind WebP can be read
    int vertex_color_ = -1;                            ///< index into Scene::textures
    int ramp_ = -1;                                    ///< index into Scene::images
};

}  // namespace nearlight::core::gltf
