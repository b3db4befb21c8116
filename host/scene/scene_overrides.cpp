// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_overrides.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/image/color.h"
#include "host/scene/sky/sky_light.h"
#include "host/scene/texture_loader.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

using Point = std::array<double, 3>;

constexpr SunPosition kSkySun{35, 45};  // of a sky without a sun

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ErrorKind::invalid_argument, what);
}

void check_range(double number, double low, double high, const std::string& what) {
    if (!(number >= low && number <= high)) {
        refuse(what);
    }
}

void check(const SceneOverrides& overrides) {
    for (const std::optional<Point>& point : {overrides.origin, overrides.target, overrides.up}) {
        if (point && !std::ranges::all_of(*point, [](double x) { return std::abs(x) < 1e30; })) {
            refuse("the origin, the target and the up vector of the camera must be finite numbers");
        }
    }
    if (overrides.fov_degrees) {
        check_range(*overrides.fov_degrees, 1e-3, 179.9,
                    "the field of view must lie between 0 and 180 degrees");
    }
    if (overrides.sun) {
        check_range(overrides.sun->elevation, 0, 90, "the sun's elevation must lie between 0 and 90 degrees");
        check_range(overrides.sun->azimuth, -1e6, 1e6,
                    "the sun's azimuth must be a finite number of degrees");
    }
    check_range(overrides.environment_rotation, -1e6, 1e6,
                "the rotation of the environment must be a finite number of degrees");
    for (const double scale : {overrides.environment_scale, overrides.light_scale}) {
        check_range(scale, 0, 1e30, "the scale of light must be a finite number, 0 or more");
    }
}

Point position_of(const Mat4& m) {
    return {m(0, 3), m(1, 3), m(2, 3)};
}

/// The axis of the world that is nearest to the camera's up, unless the camera is to look along it.
Point upward_axis(const SceneCamera& camera, const Point& view) {
    const double distance = std::hypot(view[0], view[1], view[2]);
    int up = 1;
    for (int axis = 0; axis < 3; ++axis) {
        up = std::abs(camera.to_world(axis, 1)) > std::abs(camera.to_world(up, 1)) + 1e-6 ? axis : up;
    }
    const double sign = camera.to_world(up, 1) < 0 ? -1 : 1;
    if (std::abs(view[static_cast<std::size_t>(up)]) > 0.9999 * distance) {
        up = up == 2 ? 1 : 2;  // straight up or down
    }
    Point axis{0, 0, 0};
    axis[static_cast<std::size_t>(up)] = sign;
    return axis;
}

bool are_parallel(const Point& a, const Point& b) {
    const double x = a[1] * b[2] - a[2] * b[1];
    const double y = a[2] * b[0] - a[0] * b[2];
    const double z = a[0] * b[1] - a[1] * b[0];
    return !(std::hypot(x, y, z) > 1e-9 * std::hypot(a[0], a[1], a[2]) * std::hypot(b[0], b[1], b[2]));
}

void aim(SceneCamera& camera, const Point& origin, const Point& target, const std::optional<Point>& up) {
    const Point view{target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]};
    if (!(std::hypot(view[0], view[1], view[2]) > 0)) {
        refuse("the camera's origin and target are the same point; give two points");
    }
    if (up && are_parallel(*up, view)) {
        refuse("the camera looks along its up vector; give another one");
    }
    camera.to_world = look_at(origin, target, up.value_or(upward_axis(camera, view)));
}

/// A point 1 m before the camera.
Point ahead_of(const Mat4& m) {
    return {m(0, 3) + m(0, 2), m(1, 3) + m(1, 2), m(2, 3) + m(2, 2)};
}

void apply_camera(Scene& scene, const SceneOverrides& overrides) {
    if (!overrides.origin && !overrides.target && !overrides.up && !overrides.fov_degrees) {
        return;
    }
    SceneCamera& camera = scene.camera;
    if (camera.kind == CameraKind::orthographic) {
        camera.kind = CameraKind::perspective;
        camera.fov_x_degrees = 45.0;
    }
    if (overrides.fov_degrees) {
        camera.fov_x_degrees = *overrides.fov_degrees;
        camera.center_x = camera.center_y = 0.0;
        camera.film_part = 1.0;
    }
    if (overrides.origin || overrides.target || overrides.up) {
        const Vec3 middle = bounds(scene).center();
        const Point own = overrides.origin ? Point{middle.x, middle.y, middle.z} : ahead_of(camera.to_world);
        aim(camera, overrides.origin.value_or(position_of(camera.to_world)), overrides.target.value_or(own),
            overrides.up);
    }
}

/// Numbers separated by commas; empty if the text is anything else.
std::vector<float> numbers_in(const std::string& text) {
    std::vector<float> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        float number = 0;
        const auto [after, error] = std::from_chars(at, end, number);
        if (error != std::errc{} || (after != end && *after != ',')) {
            return {};
        }
        numbers.push_back(number);
        if (after == end) {
            return numbers;
        }
        at = after + 1;
    }
}

/// The colour that the text names as R,G,B, as one number, or as #rrggbb.
std::optional<Vec3> color_named(const std::string& text) {
    std::uint32_t code = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), code, 16);
    if (text.size() == 7 && text[0] == '#' && error == std::errc{} && end == text.data() + 7) {
        const auto channel = [&](unsigned shift) {
            return srgb_to_linear(static_cast<float>(code >> shift & 255u) / 255.0f);
        };
        return Vec3{channel(16), channel(8), channel(0)};
    }
    const std::vector<float> numbers = numbers_in(text);
    if (numbers.size() != 1 && numbers.size() != 3) {
        return std::nullopt;
    }
    const Vec3 color =
        numbers.size() == 1 ? Vec3{1, 1, 1} * numbers[0] : Vec3{numbers[0], numbers[1], numbers[2]};
    if (!is_finite(color) || !(min(color, {0, 0, 0}) == Vec3{0, 0, 0})) {
        refuse("the colour '" + text + "' of the environment must be finite, and not below 0");
    }
    return color;
}

/// A sky with its sun there, which shines if `has_sun` is set.
SkyLight sky_of(const SunPosition& sun, bool has_sun) {
    const double azimuth = sun.azimuth * std::numbers::pi / 180;
    const double elevation = sun.elevation * std::numbers::pi / 180;
    // The model's +X is the world's +X, and its +Y the world's −Z.
    return {.sun = normalize({static_cast<float>(std::sin(azimuth) * std::cos(elevation)),
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
    std::size_t bad_pixels = 0;
    light = load_environment(name, 1.0f, bad_pixels);
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
    const auto scale = static_cast<float>(overrides.environment_scale);
    for (Vec3& radiance : light.radiance) {
        radiance *= scale;
    }
    if (!overrides.sun) {
        light.sun_radiance *= scale;
    }
    if (overrides.environment_rotation != 0) {
        const Mat4 turn = rotation(0, 1, 0, overrides.environment_rotation);
        light.to_world = turn * light.to_world;
        if (!overrides.sun) {
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

void apply_overrides(Scene& scene, const SceneOverrides& overrides, NoteSink& notes) {
    check(overrides);
    apply_camera(scene, overrides);
    apply_environment(scene, overrides, notes);
    if (overrides.light_scale != 1) {
        scale_light(scene, static_cast<float>(overrides.light_scale));
    }
}

}  // namespace nearlight::core
