// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/texture_maker.h"

#include "host/scene/file_text.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr Vec3 kMissing{0.5f, 0.5f, 0.5f};

// The affine map (u, v) → (s, t) of Mitsuba's coordinates.
struct UvMap {
    double a = 1, b = 0, c = 0;  // s = a·u + b·v + c
    double d = 0, e = 1, f = 0;  // t = d·u + e·v + f
};

UvMap read_uv_map(const Object& texture) {
    const Mat4 m = texture.transform("to_uv");
    UvMap map{m(0, 0), m(0, 1), m(0, 3), m(1, 0), m(1, 1), m(1, 3)};
    // Mitsuba 0.5 and 0.6 scale the coordinates, then move them.
    const double uv_scale = texture.number("uvscale", 1.0);
    const double u_scale = texture.number("uscale", uv_scale);
    const double v_scale = texture.number("vscale", uv_scale);
    map.a *= u_scale;
    map.b *= u_scale;
    map.c = map.c * u_scale + texture.number("uoffset", 0.0);
    map.d *= v_scale;
    map.e *= v_scale;
    map.f = map.f * v_scale + texture.number("voffset", 0.0);
    return map;
}

// Shapes give v' = 1 − v, so v is put back first; a bitmap's t is then counted from the bottom, too.
void set_uv_map(Texture& texture, const UvMap& map, bool from_bottom) {
    texture.u_scale = static_cast<float>(map.a);
    texture.u_shear = static_cast<float>(-map.b);
    texture.u_offset = static_cast<float>(map.b + map.c);
    const double sign = from_bottom ? -1.0 : 1.0;
    texture.v_shear = static_cast<float>(sign * map.d);
    texture.v_scale = static_cast<float>(-sign * map.e);
    texture.v_offset = static_cast<float>((from_bottom ? 1.0 : 0.0) + sign * (map.e + map.f));
}

}  // namespace

Vec3 TextureMaker::clamp_reflectance(Vec3 color, const Location& where, const std::string& name) {
    const Vec3 clamped = min(max(color, {0, 0, 0}), {1, 1, 1});
    if (!(clamped == color)) {
        note(notes_, where, "'" + name + "' lies outside 0 to 1 and is clamped");
    }
    return clamped;
}

TextureMaker::Reflectance TextureMaker::reflectance(const Object& owner, const std::string& name,
                                                    Vec3 fallback) {
    if (const Object* texture = owner.texture(name)) {
        const int index = texture_index(*texture);
        return index < 0 ? Reflectance{kMissing, -1} : Reflectance{{1, 1, 1}, index};
    }
    const std::optional<Color> color = owner.color(name);
    if (!color) {
        return {fallback, -1};
    }
    return {clamp_reflectance(color->reflectance, owner.find(name)->where, name), -1};
}

Vec3 TextureMaker::mean_reflectance(const Object& owner, const std::string& name, Vec3 fallback) {
    const Vec3 value = color(owner, name, fallback, false);
    return clamp_reflectance(value, owner.has(name) ? owner.find(name)->where : owner.where, name);
}

Vec3 TextureMaker::color(const Object& owner, const std::string& name, Vec3 fallback, bool light) {
    if (const Object* texture = owner.texture(name)) {
        note(
            notes_, texture->where,
            "a texture for '" + name + "' of " + owner.tag + " '" + owner.type + "' is replaced by its mean");
        return mean(*texture);
    }
    const std::optional<Color> color = owner.color(name);
    return !color ? fallback : light ? color->light : color->reflectance;
}

Vec3 TextureMaker::mean(const Object& texture) {
    const int index = texture_index(texture);
    if (index < 0) {
        return kMissing;
    }
    const SceneTexture& made = scene_.textures[static_cast<std::size_t>(index)];
    if (made.parameters.kind == NEARLIGHT_TEXTURE_CHECKERBOARD) {
        return (made.parameters.color0 + made.parameters.color1) * 0.5f;
    }
    return mean_color(scene_.images[static_cast<std::size_t>(made.image)]);
}

int TextureMaker::texture_index(const Object& texture) {
    if (const auto found = made_.find(&texture); found != made_.end()) {
        return found->second;
    }
    int& index = made_.emplace(&texture, -1).first->second;  // a texture that contains itself finds this
    if (texture.type == "bitmap") {
        index = make_bitmap(texture);
    } else if (texture.type == "checkerboard") {
        index = make_checkerboard(texture);
    } else {
        fail_unknown_type(texture, "bitmap, checkerboard");
    }
    texture.report_unused(notes_);
    return index;
}

int TextureMaker::make_bitmap(const Object& texture) {
    texture.ignore({"max_anisotropy", "cache", "format", "accel"});
    const std::string filter = texture.string("filter_type", "bilinear");
    if (filter == "nearest") {
        note(notes_, texture.where,
             "the filter 'nearest' is not supported; the texture is filtered bilinearly");
    }
    const std::string wrap = texture.string("wrap_mode", "repeat");
    if (wrap != "repeat" || texture.string("wrap_mode_u", "repeat") != "repeat" ||
        texture.string("wrap_mode_v", "repeat") != "repeat") {
        note(notes_, texture.where, "this wrap mode is not supported; the texture repeats");
    }
    const double gamma = texture.number("gamma", -1.0);
    if (gamma > 0.0 && gamma != 1.0) {
        note(notes_, texture.where, "this gamma is not supported; the texture is read as sRGB or linear");
    }
    const bool linear = texture.boolean("raw", false) || gamma == 1.0;
    const std::filesystem::path file = resolve_path(*texture.where.file, texture.required_string("filename"));
    const UvMap map = read_uv_map(texture);
    const int image = loader_.load(file, linear, *texture.where.file, texture.where.line);
    if (image < 0) {
        return -1;
    }
    SceneTexture made = plain_texture(image);
    set_uv_map(made.parameters, map, true);
    scene_.textures.push_back(made);
    return static_cast<int>(scene_.textures.size()) - 1;
}

int TextureMaker::make_checkerboard(const Object& texture) {
    SceneTexture made;
    made.parameters.kind = NEARLIGHT_TEXTURE_CHECKERBOARD;
    made.parameters.color0 = mean_reflectance(texture, "color0", {0.4f, 0.4f, 0.4f});
    made.parameters.color1 = mean_reflectance(texture, "color1", {0.2f, 0.2f, 0.2f});
    set_uv_map(made.parameters, read_uv_map(texture), false);
    scene_.textures.push_back(made);
    return static_cast<int>(scene_.textures.size()) - 1;
}

}  // namespace nearlight::core::mitsuba
