// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/emitter_maker.h"

#include <algorithm>

#include "host/scene/file_text.h"
#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

Vec3 emitted(const Object& emitter, const char* name, TextureMaker& textures) {
    if (!emitter.has(name) && emitter.texture(name) == nullptr) {
        fail(emitter.where, "emitter '" + emitter.type + "' needs '" + name + "'");
    }
    const Vec3 color = textures.color(emitter, name, {1, 1, 1}, true);
    if (color.x < 0.0f || color.y < 0.0f || color.z < 0.0f) {
        fail(emitter.where, std::string("'") + name + "' should not be negative");
    }
    return color;
}

Emitter make_point(const Object& emitter, TextureMaker& textures) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_POINT;
    light.radiance = emitted(emitter, "intensity", textures);
    const Triple p = emitter.triple("position", {0, 0, 0});
    light.position =
        transform_point(emitter.transform("to_world"),
                        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    return light;
}

Emitter make_spot(const Object& emitter, TextureMaker& textures, NoteSink& notes) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_SPOT;
    light.radiance = emitted(emitter, "intensity", textures);
    const Mat4 to_world = emitter.transform("to_world");
    light.position = transform_point(to_world, {0, 0, 0});
    light.direction = normalize(transform_vector(to_world, {0, 0, 1}));
    const double cutoff = emitter.number("cutoff_angle", 20.0);
    const double beam = emitter.number("beam_width", cutoff * 0.75);
    if (!(cutoff > 0.0 && cutoff <= 180.0 && beam >= 0.0 && beam <= cutoff)) {
        fail(emitter.where, "a spot needs 0 <= beam_width <= cutoff_angle <= 180");
    }
    light.cutoff_angle = degrees_to_radians(static_cast<float>(cutoff));
    light.beam_angle = degrees_to_radians(static_cast<float>(beam));
    if (emitter.texture("texture") != nullptr) {
        note(notes, emitter.where, "the texture of a spot light is left out");
    }
    return light;
}

// Keeps only the rotation, because an environment is infinitely far away.
Mat4 rotation_of(const Mat4& m, const Location& where) {
    Mat4 rotation;
    for (int column = 0; column < 3; ++column) {
        const double l = std::sqrt(m(0, column) * m(0, column) + m(1, column) * m(1, column) +
                                   m(2, column) * m(2, column));
        if (!(l > 0.0)) {
            fail(where, "the to_world of an environment should be a rotation");
        }
        for (int row = 0; row < 3; ++row) {
            rotation(row, column) = m(row, column) / l;
        }
    }
    return rotation;
}

EnvironmentLight make_environment(const Object& emitter, TextureMaker& textures, NoteSink& notes) {
    EnvironmentLight light;
    if (emitter.type == "constant") {
        light.width = 1;
        light.height = 1;
        light.radiance = {emitted(emitter, "radiance", textures)};
    } else {
        const std::filesystem::path file =
            resolve_path(*emitter.where.file, emitter.required_string("filename"));
        try {
            std::size_t bad_pixels = 0;
            light = load_environment(file, static_cast<float>(emitter.number("scale", 1.0)), bad_pixels);
            if (bad_pixels > 0) {
                note(notes, emitter.where,
                     std::to_string(bad_pixels) +
                         " pixels of the environment are negative or not finite, and count as black");
            }
        } catch (const Error& error) {
            throw Error(error.kind(), to_string(Note{*emitter.where.file, emitter.where.line, error.what()}),
                        error.setting());
        }
    }
    light.to_world = rotation_of(emitter.transform("to_world"), emitter.where);
    if (std::ranges::all_of(light.radiance, is_zero)) {
        notes.remark(*emitter.where.file, emitter.where.line, "the environment is black");
    }
    return light;
}

}  // namespace

void add_emitter(const Object& emitter, Scene& scene, TextureMaker& textures, NoteSink& notes) {
    emitter.ignore({"sampling_weight"});
    if (emitter.has("power")) {
        fail(emitter.where, "'power' is not supported; give 'intensity' or 'radiance'");
    }
    if (emitter.type == "point") {
        scene.delta_emitters.push_back(make_point(emitter, textures));
    } else if (emitter.type == "spot") {
        scene.delta_emitters.push_back(make_spot(emitter, textures, notes));
    } else if (emitter.type == "constant" || emitter.type == "envmap") {
        if (scene.environment.width > 0) {
            fail(emitter.where, "a scene can have only one environment");
        }
        emitter.ignore({"cache", "gamma"});
        scene.environment = make_environment(emitter, textures, notes);
    } else if (emitter.type == "area") {
        fail(emitter.where, "an area light must be nested in a shape");
    } else {
        fail_unknown_type(emitter, "area (nested in a shape), point, spot, constant, envmap");
    }
    emitter.report_unused(notes);
}

}  // namespace nearlight::core::mitsuba
