// SPDX-License-Identifier: Apache-2.0
// Mitsuba's BSDFs: which of them share a material, and how they nest.
#pragma once

#include <map>

#include "host/scene/mitsuba/surface_models.h"
#include "host/scene/mitsuba/texture_maker.h"

namespace nearlight::core::mitsuba {

class MaterialMaker {
  public:
    MaterialMaker(Scene& scene, NoteSink& notes, TextureMaker& textures)
        : scene_(scene), notes_(notes), textures_(textures), models_(scene, notes, textures) {}

    /// The index into Scene::materials that all shapes of this BSDF and emission share. Null stands for
    /// Mitsuba's default: a diffuse reflectance of 0.5, or 0 where light is emitted.
    uint index(const Object* bsdf, const Parameter& emission);
    uint index(const Object* bsdf, Vec3 emission) { return index(bsdf, parameter_of(emission)); }

  private:
    [[nodiscard]] uint make_shining(const Object* bsdf, const Parameter& emission);
    /// Names the material of a BSDF after its id, or that of the BSDF that it wraps.
    void name(const Object& bsdf, uint material);
    /// The index of the material without emission; `depth` counts the BSDFs around this one.
    uint make(const Object& bsdf, int depth);
    uint make_new(const Object& bsdf, int depth);
    uint add(const Material& material);
    uint make_nested(const Object& wrapper, int depth);
    uint make_twosided(const Object& bsdf, int depth);
    uint make_mask(const Object& bsdf, int depth);
    uint make_blend(const Object& bsdf, int depth);
    /// Mitsuba 0.5's mixture, as a blend of each BSDF with all that follow it. What the weights lack of 1 is
    /// black.
    uint make_mixture(const Object& bsdf, int depth);
    /// Mitsuba 0.6's coats: light passes the coat, is reflected below it once, and passes it again.
    uint make_coating(const Object& bsdf, int depth);
    uint make_bump(const Object& bsdf, int depth);
    uint make_normal_map(const Object& bsdf, int depth);
    /// What lies under a normal or bump map, with notes of what of the map is left out.
    uint make_under_map(const Object& map, int depth);

    Scene& scene_;
    NoteSink& notes_;
    TextureMaker& textures_;
    SurfaceModels models_;
    std::map<const Object*, uint> made_;
    std::map<const Object*, std::size_t> numbers_;  ///< of BSDFs that shapes use, in their order
    std::map<std::pair<const Object*, std::array<float, 4>>, uint> indices_;
};

}  // namespace nearlight::core::mitsuba
