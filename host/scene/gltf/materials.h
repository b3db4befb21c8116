// SPDX-License-Identifier: Apache-2.0
// Converts glTF's metallic-roughness materials to those of the scene.
#pragma once

#include <compare>
#include <map>
#include <vector>

#include "host/scene/gltf/surface_model.h"
#include "host/scene/gltf/textures.h"
#include "host/scene/layered_materials.h"

namespace nearlight::core::gltf {

/// What a mesh has to say about its material.
struct MaterialUse {
    int index = -1;             ///< of the material in the file; −1: none, which is grey
    bool has_colors = false;    ///< the vertices have colours
    bool has_alphas = false;    ///< and an alpha, as the first of their second texture coordinates
    bool is_mirrored = false;   ///< texture coordinates run clockwise as seen from the front
    bool has_tangents = false;  ///< which the transform of a normal map does not turn
    float scale = 1;  ///< of lengths from the mesh to the world; 1 unless the material absorbs light inside

    auto operator<=>(const MaterialUse&) const = default;
};

/// Makes each material when a mesh first asks for it: a principled one for metals and bases that reflect,
/// diffuse for bases that do not, glass where light is transmitted, and thin sheets where it diffuses
/// through. Masks, blends and normal maps lie around it. What is left out or replaced by its mean is noted.
class MaterialMaker {
  public:
    MaterialMaker(const GltfFile& file, Scene& scene, NoteSink& notes)
        : file_(file), scene_(scene), notes_(notes), textures_(file, scene, notes) {}

    /// The index of the material in Scene::materials.
    uint material(const MaterialUse& use);
    /// The texture coordinates that the material's textures ask for.
    [[nodiscard]] TextureSets texture_sets(int index) const;
    /// Whether the material has a normal map, which tells mirrored texture coordinates from others.
    [[nodiscard]] bool has_normal_map(int index) const;
    /// Whether the normal map has KHR_texture_transform.
    [[nodiscard]] bool has_placed_normal_map(int index) const;
    /// Whether the material has holes, or lets light through.
    [[nodiscard]] bool is_transparent(int index) const;
    /// Whether the alpha of vertices is to multiply their colours (surface_model.h).
    [[nodiscard]] bool shines_by_alpha(int index) const;
    /// Whether bodies of the material absorb light, more of it the larger they are.
    [[nodiscard]] bool absorbs_inside(int index) const;
    /// Whether light should leave the back of its surfaces, too.
    [[nodiscard]] bool emits_back(int index) const;
    /// The materials of the backs of surfaces that shine to both sides (add_back_material()), made once.
    [[nodiscard]] std::vector<uint> shining_backs(const std::vector<uint>& fronts);

  private:
    [[nodiscard]] const tinygltf::Material& source_of(int index) const {
        return file_.at(file_.model.materials, index, "material", "a mesh");
    }
    void note_odd_values(const tinygltf::Material& source);
    [[nodiscard]] uint make(const tinygltf::Material& source, const MaterialUse& use);
    [[nodiscard]] uint add_surface(const SurfaceModel& surface);
    [[nodiscard]] uint add_opaque(const SurfaceModel& surface);
    [[nodiscard]] uint add_mixture(const SurfaceModel& surface);
    [[nodiscard]] uint add_sheet(const SurfaceModel& surface);
    [[nodiscard]] Material layered_base(const SurfaceModel& surface);
    [[nodiscard]] uint add_glass(const SurfaceModel& surface);
    [[nodiscard]] uint add_rough_pane(const SurfaceModel& surface, double index);
    [[nodiscard]] uint add_normal_map(const tinygltf::Material& source, const SurfaceContext& context,
                                      const MaterialUse& use, uint child);
    uint add(const Material& material);
    void approximate(const std::string& what);

    const GltfFile& file_;
    Scene& scene_;
    NoteSink& notes_;
    TextureMaker textures_;
    LayeredMaterials layered_;
    std::map<MaterialUse, uint> made_;
    std::map<uint, uint> backs_;  ///< by the materials of the fronts
};

}  // namespace nearlight::core::gltf
