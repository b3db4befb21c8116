// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/emitter_maker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/scene/mitsuba/delta_light_maker.h"
#include "host/scene/mitsuba/sky_maker.h"
#include "nearlight/error.h"

namespace nearlight::core::mitsuba {
namespace {

/// Keeps only the rotation, because an environment is infinitely far away. Each axis loses what lies along
/// those before it.
Mat4 turn_of_environment(const Mat4& m, const Location& where, NoteSink& notes) {
    constexpr double kMaxSkew = 1e-3;  // of rounded numbers
    Mat4 rotation;
    double skew = 0.0;
    double scale = 1.0;
    for (int column = 0; column < 3; ++column) {
        std::array<double, 3> axis{m(0, column), m(1, column), m(2, column)};
        const double whole = std::hypot(axis[0], axis[1], axis[2]);
        scale = std::abs(whole - 1.0) > std::abs(scale - 1.0) ? whole : scale;
        for (int other = 0; other < column; ++other) {
            const double along =
                rotation(0, other) * axis[0] + rotation(1, other) * axis[1] + rotation(2, other) * axis[2];
            skew = std::max(skew, std::abs(along) / whole);
            for (int row = 0; row < 3; ++row) {
                axis.at(static_cast<std::size_t>(row)) -= along * rotation(row, other);
            }
        }
        const double l = std::hypot(axis[0], axis[1], axis[2]);
        if (!(l > 1e-6 * whole)) {
            fail(where, "the to_world of an environment should be a rotation");
        }
        for (int row = 0; row < 3; ++row) {
            rotation(row, column) = axis.at(static_cast<std::size_t>(row)) / l;
        }
    }
    if (skew > kMaxSkew) {
        note(notes, where, "the to_world of an environment shears, which is left out");
    }
    if (std::abs(scale - 1.0) > kMaxSkew) {
        note(notes, where, "the to_world of an environment scales, which is left out");
    }
    return rotation;
}

EnvironmentLight make_environment(const Object& emitter, TextureMaker& textures, NoteSink& notes) {
    EnvironmentLight light;
    if (emitter.type == "constant") {
        light.width = 1;
        light.height = 1;
        light.radiance = {emitted_color(emitter, "radiance", textures)};
    } else {
        const std::filesystem::path file = emitter.required_file();
        try {
            std::size_t bad_pixels = 0;
            // Mitsuba 0.5 and 0.6 give a gamma, where 0 and −1 mean that of the file.
            const double gamma = std::max(emitter.number("gamma", 0.0), 0.0);
            light = load_environment(file, static_cast<float>(emitter.number("scale", 1.0)),
                                     static_cast<float>(gamma), bad_pixels);
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
    light.to_world = emitter.transform("to_world");
    light.is_interpolated = light.width > 1 && light.height > 1;
    if (std::ranges::all_of(light.radiance, [](Vec3 color) { return is_zero(color); })) {
        notes.remark(*emitter.where.file, emitter.where.line, "the environment is black");
    }
    return light;
}

}  // namespace

void add_emitter(const Object& emitter, Scene& scene, TextureMaker& textures, NoteSink& notes) {
    // Shapes refer to an area light by its id, and are made before.
    if (emitter.type == "area") {
        if (!emitter.is_on_shape) {
            notes.remark(*emitter.where.file, emitter.where.line, "no shape has this area light");
        }
        return;
    }
    emitter.ignore({"sampling_weight"});
    if (emitter.has("power")) {
        fail(emitter.where, "'power' is not supported; give 'intensity' or 'radiance'");
    }
    if (const std::optional<Emitter> light = make_delta_light(emitter, scene, textures, notes)) {
        if (emitter.number("sampling_weight", 1.0) == 0.0) {
            note(notes, emitter.where,
                 "a light whose sampling_weight is 0 is left out, as nothing finds it in Mitsuba");
            emitter.report_unused(notes);
            return;
        }
        scene.delta_emitters.push_back(*light);
    } else if (emitter.type == "constant" || emitter.type == "envmap" || is_sky(emitter)) {
        if (scene.environment.width > 0) {
            fail(emitter.where, "a scene can have only one environment");
        }
        emitter.ignore({"cache", "mis_compensation"});
        scene.environment =
            is_sky(emitter) ? make_sky(emitter, notes) : make_environment(emitter, textures, notes);
        scene.environment.to_world = turn_of_environment(scene.environment.to_world, emitter.where, notes);
    } else {
        fail_unknown_type(emitter,
                          "area (of a shape), point, spot, projector, directional, constant, envmap, sunsky, "
                          "sky, sun");
    }
    emitter.report_unused(notes);
}

}  // namespace nearlight::core::mitsuba
