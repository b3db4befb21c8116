// SPDX-License-Identifier: Apache-2.0
// Mitsuba's textures.
#pragma once

#include <map>

#include "host/scene/mitsuba/object.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core::mitsuba {

/// Makes the scene's textures from Mitsuba's. Mitsuba counts v from the top row of a bitmap, nearlight from
/// the bottom; shapes and textures both convert.
class TextureMaker {
  public:
    TextureMaker(Scene& scene, NoteSink& notes) : scene_(scene), notes_(notes), loader_(scene, notes) {}

    /// A reflectance: one colour, or a texture.
    struct Reflectance {
        Vec3 color{};
        int texture = -1;  ///< index into Scene::textures, where `color` is 1; −1 if there is none
    };
    /// The property or nested texture called `name`, clamped to [0, 1]; `fallback` if there is neither.
    Reflectance reflectance(const Object& owner, const std::string& name, Vec3 fallback);
    /// The reflectance called `name` as one colour: a texture is replaced by its mean, with a note.
    Vec3 mean_reflectance(const Object& owner, const std::string& name, Vec3 fallback);
    /// A colour called `name` that is not a reflectance; a texture is replaced by its mean. `light` says that
    /// spectra are those of a light.
    Vec3 color(const Object& owner, const std::string& name, Vec3 fallback, bool light);
    /// The index into Scene::textures of a texture element, which is made when it is first asked for; −1,
    /// with a note, if its file cannot be read.
    int texture_index(const Object& texture);

  private:
    Vec3 clamp_reflectance(Vec3 color, const Location& where, const std::string& name);
    int make_bitmap(const Object& texture);
    int make_checkerboard(const Object& texture);
    Vec3 mean(const Object& texture);

    Scene& scene_;
    NoteSink& notes_;
    TextureLoader loader_;
    std::map<const Object*, int> made_;
};

}  // namespace nearlight::core::mitsuba
