// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/delta_light_maker.h"

#include <cmath>

#include "host/scene/mitsuba/sensor_maker.h"

namespace nearlight::core::mitsuba {
namespace {

/// The axes of a light's frame in the world, unit vectors.
struct LightFrame {
    Vec3 position, x, y, z;
};

LightFrame read_frame(const Object& emitter, NoteSink& notes) {
    const Mat4 to_world = emitter.transform("to_world");
    const Vec3 x = transform_vector(to_world, {1, 0, 0});
    const Vec3 y = transform_vector(to_world, {0, 1, 0});
    const Vec3 z = transform_vector(to_world, {0, 0, 1});
    const LightFrame frame{transform_point(to_world, {0, 0, 0}), normalize(x), normalize(y), normalize(z)};
    const float longest = std::max({length(x), length(y), length(z)});
    const float shortest = std::min({length(x), length(y), length(z)});
    if (!(shortest > 0.0f) || !std::isfinite(longest)) {
        fail(emitter.where, "the to_world of emitter '" + emitter.type + "' is singular");
    }
    const float skew = std::max(
        {std::abs(dot(frame.x, frame.y)), std::abs(dot(frame.y, frame.z)), std::abs(dot(frame.z, frame.x))});
    if (longest > 1.001f * shortest || skew > 1e-3f) {
        note(notes, emitter.where,
             "the to_world of emitter '" + emitter.type + "' distorts its beam, which is left out");
    }
    return frame;
}

/// Sets the image that the light sends, where the element has a texture of that name.
void set_image(Emitter& light, const Object& emitter, const char* name, TextureMaker& textures) {
    if (const Object* texture = emitter.texture(name)) {
        light.image = static_cast<uint>(textures.texture_index(*texture) + 1);
    }
}

Emitter make_point(const Object& emitter, TextureMaker& textures) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_POINT;
    light.radiance = emitted_color(emitter, "intensity", textures);
    if (!emitter.is_old && emitter.has("position") && emitter.has("to_world")) {
        fail(emitter.where, "a point light has either 'position' or 'to_world'");
    }
    const Triple p = emitter.triple("position", {0, 0, 0});
    light.position =
        transform_point(emitter.transform("to_world"),
                        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    return light;
}

Emitter make_spot(const Object& emitter, TextureMaker& textures, NoteSink& notes) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_SPOT;
    light.radiance = emitted_color(emitter, "intensity", textures);
    const double cutoff = emitter.number("cutoff_angle", 20.0);
    const double beam = emitter.number("beam_width", cutoff * 0.75);
    if (!(cutoff > 0.0 && cutoff <= 180.0 && beam >= 0.0 && beam <= cutoff)) {
        fail(emitter.where, "a spot needs 0 <= beam_width <= cutoff_angle <= 180");
    }
    light.cutoff_angle = degrees_to_radians(static_cast<float>(cutoff));
    light.beam_angle = degrees_to_radians(static_cast<float>(beam));
    const LightFrame frame = read_frame(emitter, notes);
    light.position = frame.position;
    light.direction = frame.z;
    const float scale = 0.5f / std::tan(light.cutoff_angle);
    light.x_axis = frame.x * scale;
    light.y_axis = frame.y * scale;
    set_image(light, emitter, "texture", textures);
    return light;
}

/// The width of the projector's image divided by its height: that of its bitmap, or 1.
double image_aspect(const Emitter& light, const Scene& scene) {
    const int image = light.image == 0 ? -1 : scene.textures[light.image - 1].image;
    if (image < 0) {
        return 1.0;
    }
    const TextureImage& bitmap = scene.images[static_cast<std::size_t>(image)];
    return static_cast<double>(bitmap.width) / bitmap.height;
}

Emitter make_projector(const Object& emitter, const Scene& scene, TextureMaker& textures, NoteSink& notes) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_PROJECTOR;
    set_image(light, emitter, "irradiance", textures);
    const Vec3 color = light.image == 0 ? emitted_color(emitter, "irradiance", textures) : Vec3{1, 1, 1};
    // Mitsuba's image plane receives pi times what the texture says.
    light.radiance = color * (kPi * static_cast<float>(emitter.number("scale", 1.0)));
    const LightFrame frame = read_frame(emitter, notes);
    light.position = frame.position;
    light.direction = frame.z;
    const double aspect = image_aspect(light, scene);
    const double half_width = std::tan(degrees_to_radians(static_cast<float>(read_fov(emitter, aspect))) / 2);
    const double half_height = half_width / aspect;
    light.x_axis = frame.x * static_cast<float>(-0.5 / half_width);
    light.y_axis = frame.y * static_cast<float>(-0.5 / half_height);
    light.area = static_cast<float>(4.0 * half_width * half_height);
    return light;
}

Emitter make_directional(const Object& emitter, TextureMaker& textures) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_DIRECTIONAL;
    light.radiance = emitted_color(emitter, "irradiance", textures);
    if (emitter.has("direction") && emitter.has("to_world")) {
        fail(emitter.where, "a directional light has either 'direction' or 'to_world'");
    }
    const Triple d = emitter.triple("direction", {0, 0, 1});
    light.direction = normalize(
        transform_vector(emitter.transform("to_world"),
                         {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])}));
    if (is_zero(light.direction)) {
        fail(emitter.where, "the direction of a directional light is zero");
    }
    return light;
}

}  // namespace

Vec3 emitted_color(const Object& emitter, const char* name, TextureMaker& textures) {
    const Vec3 color = textures.color(emitter, name, {1, 1, 1}, true);
    if (color.x < 0.0f || color.y < 0.0f || color.z < 0.0f) {
        fail(emitter.where, std::string("'") + name + "' should not be negative");
    }
    return color;
}

std::optional<Emitter> make_delta_light(const Object& emitter, const Scene& scene, TextureMaker& textures,
                                        NoteSink& notes) {
    if (emitter.type == "point") {
        return make_point(emitter, textures);
    }
    if (emitter.type == "spot") {
        return make_spot(emitter, textures, notes);
    }
    if (emitter.type == "projector") {
        return make_projector(emitter, scene, textures, notes);
    }
    if (emitter.type == "directional") {
        return make_directional(emitter, textures);
    }
    return std::nullopt;
}

}  // namespace nearlight::core::mitsuba
