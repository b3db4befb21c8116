// SPDX-License-Identifier: Apache-2.0
// Mitsuba's textures.
#pragma once

#include <map>
#include <utility>

#include "host/scene/mitsuba/object.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core::mitsuba {

/// Makes the scene's textures from Mitsuba's. Mitsuba counts v from the top row of a bitmap, nearlight from
/// the bottom; shapes and textures both convert.
class TextureMaker {
  public:
    TextureMaker(Scene& scene, NoteSink& notes) : scene_(scene), notes_(notes), loader_(scene, notes) {}

    /// The numbers that a constant may be; what lies outside is limited, with a note.
    struct Range {
        float min = 0.0f;
        float max = 1.0f;
    };

    /// The bitmaps of these shapes' materials and emitters will probably be asked for, in this order.
    void expect(const std::vector<const Object*>& shapes);

    /// The colour or nested texture called `name`; `fallback` if there is neither. A constant is limited to
    /// [0, 1], with a note.
    Parameter reflectance(const Object& owner, const std::string& name, Vec3 fallback);
    /// The same of a number, with textures as their luminance.
    Parameter number(const Object& owner, const std::string& name, float fallback, Range range);
    Parameter number(const Object& owner, const std::string& name, float fallback) {
        return number(owner, name, fallback, Range{});
    }
    /// The radiance or intensity called `name`, where spectra are those of a light; textures are kept.
    Parameter emission(const Object& owner, const std::string& name, Vec3 fallback);
    /// A texture of heights (bump maps), times `scale`.
    Parameter height(const Object& texture, float scale);
    /// The normals of a `normalmap`: of its only texture, or of a constant called `normalmap`. Calls fail()
    /// for one that has neither or both.
    Parameter normals(const Object& normal_map);
    /// A colour called `name` that is not a reflectance; a texture is replaced by its mean, with a note.
    /// `light` says that spectra are those of a light.
    Vec3 color(const Object& owner, const std::string& name, Vec3 fallback, bool light);
    /// A texture element as a colour, which is made when it is first asked for; grey, with a note, if its
    /// file cannot be read.
    Parameter texture(const Object& texture) { return make(texture, Purpose::color); }
    /// The index into Scene::textures of a texture element; −1, with a note, if its file cannot be read.
    /// Calls fail() for one that scales another.
    int texture_index(const Object& texture);

  private:
    enum class Purpose { color, number, height, normals };

    Parameter make(const Object& texture, Purpose purpose);
    Parameter make_new(const Object& texture, Purpose purpose);
    Parameter make_bitmap(const Object& texture, Purpose purpose);
    Parameter make_checkerboard(const Object& texture, Purpose purpose);
    Parameter make_mesh_attribute(const Object& texture, Purpose purpose);
    Parameter make_scale(const Object& texture, Purpose purpose);
    Parameter field(const Object& checkerboard, const char* name, float fallback, Purpose purpose);
    Vec3 limited(Vec3 value, Range range, const Location& where, const std::string& name);
    void warn_of_normals_below(const Parameter& normals, const Location& where);

    Scene& scene_;
    NoteSink& notes_;
    TextureLoader loader_;
    std::map<std::pair<const Object*, Purpose>, Parameter> made_;
    int depth_ = 0;  ///< of the texture that is being made, within others
};

}  // namespace nearlight::core::mitsuba
