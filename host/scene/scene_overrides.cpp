// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_overrides.h"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/number_text.h"
#include "host/scene/sky/sky_light.h"
#include "host/scene/texture_loader.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr SunPosition kSkySun{35, 45};  // of a sky without a sun

void check_range(double number, double low, double high, const std::string& what, std::string_view setting) {
    if (!(number >= low && number <= high)) {
        throw Error(ErrorKind::invalid_argument, what, setting);
    }
}

void check(const SceneOverrides& overrides) {
    if (overrides.sun) {
        check_range(overrides.sun->elevation, 0, 90, "the sun's elevation must lie between 0 and 90 degrees",
                    "sun");
        check_range(overrides.sun->azimuth, -1e6, 1e6, "the sun's azimuth must be a finite number of degrees",
                    "sun");
    }
    check_range(overrides.environment_rotation, -1e6, 1e6,
                "the rotation of the environment must be a finite number of degrees", "environment_rotation");
    check_range(overrides.environment_scale, 0, 1e30,
                "the scale of the environment must be a finite number, 0 or more", "environment_scale");
    check_range(overrides.light_scale, 0, 1e30, "the scale of light must be a finite number, 0 or more",
                "light_scale");
}

/// Refuses an origin from which the middle of the scene lies in no direction, or only in one of rounding.
void refuse_middle(Vec3 origin, const Aabb& box) {
    if (length(origin - box.center()) <= 1e-6f * length(box.size())) {
        throw Error(ErrorKind::invalid_argument,
                    "a camera with an origin and no target looks at the middle of the scene, and this origin "
                    "is that middle; give a target, too",
                    "target");
    }
}

/// The axis of the world that is nearest to the camera's up, unless the pose looks along it.
std::array<double, 3> upward_axis(const SceneCamera& camera, const ExactPose& pose) {
    const std::array<double, 3> view{pose.target[0] - pose.origin[0], pose.target[1] - pose.origin[1],
                                     pose.target[2] - pose.origin[2]};
    int up = 1;
    for (int axis = 0; axis < 3; ++axis) {
        up = std::abs(camera.to_world(axis, 1)) > std::abs(camera.to_world(up, 1)) + 1e-6 ? axis : up;
    }
    const double sign = camera.to_world(up, 1) < 0 ? -1 : 1;
    if (std::abs(view[static_cast<std::size_t>(up)]) > 0.9999 * std::hypot(view[0], view[1], view[2])) {
        up = up == 2 ? 1 : 2;  // straight up or down
    }
    std::array<double, 3> axis{0, 0, 0};
    axis[static_cast<std::size_t>(up)] = sign;
    return axis;
}

/// The colour that the text names as R,G,B, as one number, or as #rrggbb.
std::optional<Vec3> color_named(const std::string& text) {
    if (const std::optional<Vec3> color = hex_color_in(text)) {
        return color;
    }
    const std::vector<double> numbers = numbers_in(text).value_or(std::vector<double>{});
    if (numbers.size() != 1 && numbers.size() != 3) {
        return std::nullopt;
    }
    const Vec3 color{static_cast<float>(numbers[0]), static_cast<float>(numbers[numbers.size() / 2]),
                     static_cast<float>(numbers.back())};
    if (!is_finite(color) || !(min(color, {0, 0, 0}) == Vec3{0, 0, 0})) {
        throw Error(ErrorKind::invalid_argument,
                    "the colour '" + text + "' of the environment must be finite, and not below 0",
                    "environment");
    }
    return color;
}

/// A sky with its sun there, which shines if `has_sun` is set.
SkyLight sky_of(const SunPosition& sun, bool has_sun) {
    const double azimuth = sun.azimuth * std::numbers::pi / 180;
    const double elevation = sun.elevation * std::numbers::pi / 180;
    // The model's +X is the world's +X, and its +Y the world's −Z.
    return {.sun = normalize(Vec3{static_cast<float>(std::sin(azimuth) * std::cos(elevation)),
                                  static_cast<float>(-std::cos(azimuth) * std::cos(elevation)),
                                  static_cast<float>(std::sin(elevation))}),
            .sun_scale = has_sun ? 1.0 : 0.0};
}

EnvironmentLight environment_named(const std::string& name, const Scene& scene, NoteSink& notes) {
    EnvironmentLight light;
    if (const std::optional<Vec3> color = color_named(name)) {
        light.width = light.height = 1;
        light.radiance = {*color};
        return light;
    }
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored)) {
        throw Error(ErrorKind::file,
                    "the environment '" + name +
                        "' is neither 'sky', nor a colour such as 0.5 or #88aaff, nor an "
                        "image file that is there",
                    "environment");
    }
    std::size_t bad_pixels = 0;
    light = load_environment(name, 1.0f, 0.0f, bad_pixels);
    light.is_interpolated = light.width > 1 && light.height > 1;
    if (bad_pixels > 0) {
        notes.approximation(scene.source, 0,
                            std::to_string(bad_pixels) +
                                " pixels of the environment are negative or not finite, and count as black");
    }
    return light;
}

void apply_environment(Scene& scene, const SceneOverrides& overrides, NoteSink& notes) {
    EnvironmentLight& light = scene.environment;
    const bool is_sky = overrides.environment == "sky";
    if (!overrides.environment.empty() && !is_sky) {
        light = environment_named(overrides.environment, scene, notes);
    }
    if (is_sky || overrides.sun) {
        SkyLight sky = sky_of(overrides.sun.value_or(kSkySun), overrides.sun.has_value());
        sky.sky_scale = is_sky ? 1.0 : 0.0;
        EnvironmentLight own = is_sky || light.width == 0 ? EnvironmentLight{} : light;
        if (is_sky || own.width == 0) {
            set_sky(own, sky);
        } else {
            set_sun(own, sky, {sky.sun.x, sky.sun.z, -sky.sun.y});
        }
        light = own;
    }
    const bool changes = overrides.environment_scale != 1.0 || overrides.environment_rotation != 0.0;
    if (light.width == 0 && changes) {
        notes.remark(scene.source, 0, "the scene has no environment that could be scaled or turned");
    }
    const auto scale = static_cast<float>(overrides.environment_scale);
    for (Vec3& radiance : light.radiance) {
        radiance *= scale;
    }
    // The sun of an environment belongs to it; one that is added to another environment stands where it is
    // put.
    const bool has_own_sun = is_sky || !overrides.sun;
    if (has_own_sun) {
        light.sun_radiance *= scale;
    }
    if (overrides.environment_rotation != 0) {
        const Mat4 turn = rotation(0, 1, 0, overrides.environment_rotation);
        light.to_world = turn * light.to_world;
        if (has_own_sun) {
            light.sun_direction = transform_vector(turn, light.sun_direction);
        }
    }
}

void scale_light(Scene& scene, float scale) {
    for (Material& material : scene.materials) {
        material.emission.value *= scale;
    }
    for (Emitter& emitter : scene.delta_emitters) {
        emitter.radiance *= scale;
    }
    for (Vec3& radiance : scene.environment.radiance) {
        radiance *= scale;
    }
    scene.environment.sun_radiance *= scale;
}

}  // namespace

Vec3 eye_of(const Scene& scene, const SceneOverrides& overrides) {
    if (overrides.origin) {
        const auto& [x, y, z] = *overrides.origin;
        return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    }
    return transform_point(scene.camera.to_world, {0, 0, 0});
}

SceneCamera overridden(SceneCamera camera, const Scene& scene, const SceneOverrides& overrides) {
    if (overrides.fov_degrees) {  // that of the picture, whatever part of the film it was
        camera = with_field_of_view(camera, *overrides.fov_degrees);
        camera.center_x = camera.center_y = 0.0;
        camera.film_part = 1.0;
    }
    if (!overrides.origin && !overrides.target && !overrides.up) {
        return camera;
    }
    ExactPose pose = exact_pose_of(camera);
    if (overrides.origin) {
        const Aabb box = bounds(scene);
        const Vec3 middle = box.center();
        if (!overrides.target) {
            refuse_middle(eye_of(scene, overrides), box);
        }
        pose.origin = *overrides.origin;
        pose.target = {double{middle.x}, double{middle.y}, double{middle.z}};
    }
    pose.target = overrides.target.value_or(pose.target);
    pose.up = overrides.up.value_or(upward_axis(camera, pose));
    return posed(camera, pose);
}

void apply_overrides(Scene& scene, const SceneOverrides& overrides, NoteSink& notes) {
    check(overrides);
    scene.camera = overridden(scene.camera, scene, overrides);
    apply_environment(scene, overrides, notes);
    if (overrides.light_scale != 1) {
        scale_light(scene, static_cast<float>(overrides.light_scale));
    }
}

}  // namespace nearlight::core
