// SPDX-License-Identifier: Apache-2.0
// Mitsuba's BSDFs.
#pragma once

#include <map>

#include "host/scene/mitsuba/texture_maker.h"

namespace nearlight::core::mitsuba {

class MaterialMaker {
  public:
    MaterialMaker(Scene& scene, NoteSink& notes, TextureMaker& textures)
        : scene_(scene), notes_(notes), textures_(textures) {}

    /// The index into Scene::materials that all shapes of this BSDF and emission share. Null stands for
    /// Mitsuba's default, a diffuse reflectance of 0.5.
    uint index(const Object* bsdf, Vec3 emission);

  private:
    Material make(const Object& bsdf, int depth);
    Material make_nested(const Object& wrapper, int depth);
    Material make_twosided(const Object& bsdf, int depth);
    Material make_mask(const Object& bsdf, int depth);
    Material make_blend(const Object& bsdf, int depth);
    Material make_diffuse(const Object& bsdf);
    Material make_plastic(const Object& bsdf);
    Material make_conductor(const Object& bsdf);
    Material make_glass(const Object& bsdf, bool thin);
    Material make_principled(const Object& bsdf);
    double index_of_refraction(const Object& bsdf, const std::string& name, double fallback);
    float roughness(const Object& bsdf);

    Scene& scene_;
    NoteSink& notes_;
    TextureMaker& textures_;
    std::map<const Object*, Material> made_;
    std::map<std::pair<const Object*, std::array<float, 3>>, uint> indices_;
};

}  // namespace nearlight::core::mitsuba
