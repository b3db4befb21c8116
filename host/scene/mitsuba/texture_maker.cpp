// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/texture_maker.h"

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "host/base/half.h"
#include "host/scene/material_model.h"
#include "host/scene/mitsuba/mesh_attribute.h"
#include "host/scene/texture.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr Vec3 kMissing{0.5f, 0.5f, 0.5f};
constexpr Vec3 kFlat{0.5f, 0.5f, 1.0f};  // a normal map without effect

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

std::optional<uint> wrap_of(const std::string& name) {
    return name == "repeat"   ? std::optional<uint>(NEARLIGHT_WRAP_REPEAT)
           : name == "mirror" ? std::optional<uint>(NEARLIGHT_WRAP_MIRROR)
           : name == "clamp"  ? std::optional<uint>(NEARLIGHT_WRAP_CLAMP)
                              : std::nullopt;
}

uint read_wrap(const Object& texture, const std::string& name, const std::string& fallback) {
    const std::string mode = texture.string(name, fallback);
    const std::optional<uint> wrap = wrap_of(mode);
    if (!wrap) {
        fail(texture.where,
             "wrap mode '" + mode + "' is not supported; known ones are repeat, mirror, clamp");
    }
    return *wrap;
}

// Mitsuba 0.5 and 0.6 know anisotropic filters, which average over the pixel as many samples do.
uint read_filter(const Object& texture) {
    const std::string filter = texture.string("filter_type", "bilinear");
    if (filter != "bilinear" && filter != "nearest" && filter != "ewa" && filter != "trilinear") {
        fail(texture.where, "filter '" + filter + "' is not supported; known ones are bilinear, nearest");
    }
    return filter == "nearest" ? NEARLIGHT_FILTER_NEAREST : NEARLIGHT_FILTER_BILINEAR;
}

// Mitsuba 0.5 and 0.6 give a gamma, where 0 and −1 mean that of the file.
float read_gamma(const Object& texture) {
    const double gamma = texture.number("gamma", 0.0);
    return texture.boolean("raw", false) ? 1.0f : static_cast<float>(std::max(gamma, 0.0));
}

// Mitsuba 0.6 can take one channel of a bitmap, by its name. Returns −1 for all of them.
int read_channel(const Object& texture) {
    const std::string name = texture.string("channel", "");
    constexpr std::string_view kNames = "rgbaRGBA";
    const std::size_t index = name.size() == 1 ? kNames.find(name) : std::string_view::npos;
    if (!name.empty() && index == std::string_view::npos) {
        fail(texture.where, "channel '" + name + "' is not supported; known ones are r, g, b, a");
    }
    return name.empty() ? -1 : static_cast<int>(index % 4);
}

// The texture that a texture of another kind changes.
const Object& inner_texture(const Object& texture) {
    const std::vector<const Object*> nested = texture.nested("texture");
    if (nested.size() != 1) {
        fail(texture.where, "texture '" + texture.type + "' needs one nested texture");
    }
    return *nested.front();
}

// How many textures are looked up one after the other.
int nesting(const Scene& scene, const Parameter& parameter) {
    if (parameter.texture < 0) {
        return 0;
    }
    const Texture& texture = scene.textures[static_cast<std::size_t>(parameter.texture)].parameters;
    return texture.kind == NEARLIGHT_TEXTURE_CHECKERBOARD
               ? 1 + std::max(nesting(scene, texture.color0), nesting(scene, texture.color1))
               : 1;
}

bool is_bitmap(const Object& texture) {
    return texture.type == "bitmap" || texture.type == "ldrtexture" || texture.type == "exrtexture";
}

/// The files of the bitmaps that lie within these objects, in their order.
std::vector<ImageSource> bitmaps_within(const std::vector<const Object*>& objects) {
    std::vector<ImageSource> files;
    visit_all(objects, [&](const Object& object) {
        const Property* const file = object.find("filename");
        if (is_bitmap(object) && file != nullptr && std::holds_alternative<std::string>(file->value)) {
            files.push_back({.file = std::get<std::string>(file->value)});
        }
    });
    return files;
}

constexpr int kMaxDepth = 64;  // of textures that change others
constexpr const char* kKnownTextures = "bitmap, checkerboard, mesh_attribute, scale";

}  // namespace

Vec3 TextureMaker::limited(Vec3 value, Range range, const Location& where, const std::string& name) {
    const Vec3 limited = min(max(value, Vec3{1, 1, 1} * range.min), Vec3{1, 1, 1} * range.max);
    if (!(limited == value)) {
        note(notes_, where,
             "'" + name + "' lies outside " + std::to_string(static_cast<int>(range.min)) + " to " +
                 std::to_string(static_cast<int>(range.max)) + " and is limited");
    }
    return limited;
}

Parameter TextureMaker::reflectance(const Object& owner, const std::string& name, Vec3 fallback) {
    if (const Object* texture = owner.texture(name)) {
        return make(*texture, Purpose::color);
    }
    const std::optional<Color> color = owner.color(name);
    return parameter_of(color ? limited(color->reflectance, {}, owner.find(name)->where, name) : fallback);
}

Parameter TextureMaker::number(const Object& owner, const std::string& name, float fallback, Range range) {
    if (const Object* texture = owner.texture(name)) {
        return make(*texture, Purpose::number);
    }
    const std::optional<Color> color = owner.color(name);
    if (!color) {
        return parameter_of(fallback);
    }
    // Mitsuba takes the mean of a colour's channels, but the luminance of a texture.
    const Vec3 c = color->reflectance;
    const float value = c.x == c.y && c.y == c.z ? c.x : (c.x + c.y + c.z) / 3.0f;
    return parameter_of(limited(Vec3{1, 1, 1} * value, range, owner.find(name)->where, name));
}

Parameter TextureMaker::emission(const Object& owner, const std::string& name, Vec3 fallback) {
    if (const Object* texture = owner.texture(name)) {
        return make(*texture, Purpose::color);
    }
    return parameter_of(color(owner, name, fallback, true));
}

Parameter TextureMaker::height(const Object& texture, float scale) {
    Parameter height = make(texture, Purpose::height);
    height.value *= scale;
    return height;
}

Parameter TextureMaker::normals(const Object& normal_map) {
    const std::vector<const Object*> textures = normal_map.nested("texture");
    const std::optional<Color> everywhere = normal_map.color("normalmap");
    if (textures.size() + (everywhere ? 1 : 0) != 1) {
        fail(normal_map.where, "'normalmap' needs one nested texture");
    }
    if (everywhere) {
        if (everywhere->reflectance.z <= 0.5f) {
            note(notes_, normal_map.where, "the normal of the normal map points below the surface");
        }
        return parameter_of(everywhere->reflectance);
    }
    const Parameter normals = make(*textures.front(), Purpose::normals);
    warn_of_normals_below(normals, textures.front()->where);
    return normals;
}

Vec3 TextureMaker::color(const Object& owner, const std::string& name, Vec3 fallback, bool light) {
    if (const Object* texture = owner.texture(name)) {
        note(
            notes_, texture->where,
            "a texture for '" + name + "' of " + owner.tag + " '" + owner.type + "' is replaced by its mean");
        return mean_value(scene_, make(*texture, Purpose::color));
    }
    const std::optional<Color> color = owner.color(name);
    return !color ? fallback : light ? color->light : color->reflectance;
}

int TextureMaker::texture_index(const Object& texture) {
    const Parameter made = make(texture, Purpose::color);
    if (made.texture >= 0 && !(made.value == Vec3{1, 1, 1})) {
        fail(texture.where, "a scaled texture is not supported here");
    }
    return made.texture;
}

void TextureMaker::expect(const std::vector<const Object*>& shapes) {
    loader_.expect(bitmaps_within(shapes));
}

Parameter TextureMaker::make(const Object& texture, Purpose purpose) {
    const auto [entry, is_new] = made_.try_emplace({&texture, purpose}, parameter_of(kMissing));
    if (is_new) {  // a texture that contains itself finds grey
        if (depth_ >= kMaxDepth) {
            fail(texture.where, "more than " + std::to_string(kMaxDepth) + " textures lie within each other");
        }
        ++depth_;
        entry->second = make_new(texture, purpose);
        --depth_;
        texture.report_unused(notes_);
    }
    return entry->second;
}

Parameter TextureMaker::make_new(const Object& texture, Purpose purpose) {
    const std::string& type = texture.type;
    if (is_bitmap(texture)) {
        return make_bitmap(texture, purpose);
    }
    if (type == "checkerboard") {
        return make_checkerboard(texture, purpose);
    }
    if (is_mesh_attribute(texture)) {
        return make_mesh_attribute(texture, purpose);
    }
    if (type == "scale") {
        return make_scale(texture, purpose);
    }
    fail_unknown_type(texture, kKnownTextures);
}

Parameter TextureMaker::make_bitmap(const Object& texture, Purpose purpose) {
    texture.ignore({"max_anisotropy", "cache", "format", "accel"});
    const std::string wrap = texture.string("wrap_mode", "repeat");
    SceneTexture made = plain_texture(-1);
    made.parameters.wrap_s = read_wrap(texture, "wrap_mode_u", wrap);
    made.parameters.wrap_t = read_wrap(texture, "wrap_mode_v", wrap);
    made.parameters.filter = read_filter(texture);
    set_uv_map(made.parameters, read_uv_map(texture), true);
    TexelRule rule;
    rule.gamma = read_gamma(texture);
    rule.channel = read_channel(texture);
    rule.is_encoded = true;
    rule.is_number = purpose == Purpose::number || purpose == Purpose::height;
    rule.is_signed = purpose == Purpose::height || purpose == Purpose::normals;
    const std::filesystem::path file = texture.required_file();
    made.image = loader_.load({.file = file}, rule, *texture.where.file, texture.where.line);
    if (made.image < 0) {
        return parameter_of(purpose == Purpose::normals ? kFlat : kMissing);
    }
    return textured(add_texture(scene_, made));
}

Parameter TextureMaker::field(const Object& checkerboard, const char* name, float fallback, Purpose purpose) {
    if (const Object* texture = checkerboard.texture(name)) {
        return make(*texture, purpose);
    }
    // A field may be as large as a texel, because only the parameter that the board belongs to has a range.
    return purpose == Purpose::number || purpose == Purpose::height
               ? number(checkerboard, name, fallback, {0.0f, kMaxHalf})
               : reflectance(checkerboard, name, Vec3{1, 1, 1} * fallback);
}

Parameter TextureMaker::make_checkerboard(const Object& texture, Purpose purpose) {
    SceneTexture made = plain_texture(-1);
    made.parameters.kind = NEARLIGHT_TEXTURE_CHECKERBOARD;
    made.parameters.color0 = field(texture, "color0", 0.4f, purpose);
    made.parameters.color1 = field(texture, "color1", 0.2f, purpose);
    if (purpose == Purpose::number && !texture.is_old) {
        // Mitsuba 3 exchanges the fields where it looks a number up.
        std::swap(made.parameters.color0, made.parameters.color1);
    }
    set_uv_map(made.parameters, read_uv_map(texture), false);
    const Parameter board = textured(add_texture(scene_, made));
    if (nesting(scene_, board) > NEARLIGHT_MAX_TEXTURE_NESTING) {
        fail(texture.where, "more than " + std::to_string(NEARLIGHT_MAX_TEXTURE_NESTING) +
                                " checkerboards lie within each other");
    }
    return board;
}

Parameter TextureMaker::make_mesh_attribute(const Object& texture, Purpose purpose) {
    const std::string name = texture.string("name", kVertexColor);
    if (!name.starts_with("vertex_") && !name.starts_with("face_")) {
        fail(texture.where,
             "the name of a mesh attribute begins with 'vertex_' or 'face_', not as '" + name + "' does");
    }
    if (purpose == Purpose::height || purpose == Purpose::normals) {
        fail(texture.where, "mesh attribute '" + name + "' is only supported as a colour or a number");
    }
    return textured(add_texture(scene_, vertex_color_texture()),
                    static_cast<float>(texture.number("scale", 1.0)));
}

// Mitsuba 0.5 and 0.6 scale textures by another one.
Parameter TextureMaker::make_scale(const Object& texture, Purpose purpose) {
    Parameter made = make(inner_texture(texture), purpose);
    const std::optional<Color> scale = texture.color(texture.has("value") ? "value" : "scale");
    if (scale) {
        made.value *= scale->reflectance;
    }
    return made;
}

void TextureMaker::warn_of_normals_below(const Parameter& normals, const Location& where) {
    if (normals.texture < 0) {
        return;
    }
    const SceneTexture& texture = scene_.textures[static_cast<std::size_t>(normals.texture)];
    if (texture.image < 0) {
        return;
    }
    const TextureImage& image = scene_.images[static_cast<std::size_t>(texture.image)];
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::size_t below = 0;
    for (std::size_t i = 0; i < count; ++i) {
        below += texel_color(image, i).z * normals.value.z <= 0.5f ? 1 : 0;
    }
    if (below > 0) {
        note(
            notes_, where,
            std::to_string(below) + " texels of the normal map '" + image.name + "' point below the surface");
    }
}

}  // namespace nearlight::core::mitsuba
