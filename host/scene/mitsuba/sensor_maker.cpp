// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/sensor_maker.h"

#include <numbers>

#include "host/base/words.h"
#include "host/scene/mitsuba/film_maker.h"
#include "host/scene/mitsuba/values.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr double kRadian = 180.0 / std::numbers::pi;

// Converts the focal length of a 35 mm camera (film of 36 × 24 mm) to a diagonal field of view.
double fov_of_focal_length(const Object& sensor) {
    std::string text = sensor.string("focal_length", "50mm");
    if (text.ends_with("mm")) {
        text.resize(text.size() - 2);
    }
    const double length = parse_number(text, sensor.where);
    if (!(length > 0.0)) {
        fail(sensor.where, "'focal_length' should be greater than 0");
    }
    return 2.0 * std::atan(std::hypot(36.0, 24.0) / (2.0 * length)) * kRadian;
}

double positive_number(const Object& sensor, const char* name, double fallback) {
    const double value = sensor.number(name, fallback);
    if (!(value > 0.0)) {
        fail(sensor.find(name)->where, std::string("'") + name + "' should be greater than 0");
    }
    return value;
}

// Scaling the camera does not change the picture, but mirroring would.
Mat4 without_scale(Mat4 m, const Location& where) {
    for (int column = 0; column < 3; ++column) {
        const double l = std::sqrt(m(0, column) * m(0, column) + m(1, column) * m(1, column) +
                                   m(2, column) * m(2, column));
        if (!(l > 0.0) || !std::isfinite(l)) {
            fail(where, "the sensor's to_world is singular: it maps space onto a plane, a line or a point");
        }
        for (int row = 0; row < 3; ++row) {
            m(row, column) /= l;
        }
    }
    return m;
}

void apply_clip(const Object& sensor, SceneCamera& camera) {
    camera.near_clip = positive_number(sensor, "near_clip", 1e-2);
    camera.far_clip = positive_number(sensor, "far_clip", 1e4);
    if (camera.near_clip >= camera.far_clip) {
        fail(sensor.where, "'near_clip' should be smaller than 'far_clip'");
    }
}

void apply_optics(const Object& sensor, const FilmSize& film, SceneCamera& camera) {
    if (sensor.type == "thinlens") {
        if (!sensor.has("aperture_radius")) {
            fail(sensor.where, "sensor 'thinlens' needs a float 'aperture_radius'");
        }
        camera.aperture_radius = sensor.number("aperture_radius", 0.0);
        if (!(camera.aperture_radius >= 0.0)) {
            fail(sensor.find("aperture_radius")->where, "'aperture_radius' should be 0 or greater");
        }
        camera.focus_distance = positive_number(sensor, "focus_distance", camera.far_clip);
        return;
    }
    // Offsets are relative to the film's width and height, and centers to its width alone.
    camera.center_x += sensor.number("principal_point_offset_x", 0.0);
    camera.center_y += sensor.number("principal_point_offset_y", 0.0) * film.height / film.width;
}

}  // namespace

double read_fov(const Object& owner, double aspect) {
    if (owner.has("fov") && owner.has("focal_length")) {
        fail(owner.find("fov")->where, "it has both 'fov' and 'focal_length'; give one of them");
    }
    owner.ignore({"fov_axis"});
    if (!owner.has("fov")) {
        return horizontal_fov(fov_of_focal_length(owner), "diagonal", aspect, owner.where);
    }
    const double fov = owner.number("fov", 0.0);
    if (!(fov > 0.0 && fov < 180.0)) {
        fail(owner.find("fov")->where, "'fov' should be between 0 and 180");
    }
    return horizontal_fov(fov, lower_case(owner.string("fov_axis", "x")), aspect, owner.where);
}

double horizontal_fov(double fov_degrees, const std::string& axis, double aspect, const Location& where) {
    const double half = std::tan(0.5 * fov_degrees / kRadian);
    double horizontal = half;
    if (axis == "y" || (axis == "smaller" && aspect > 1.0) || (axis == "larger" && aspect < 1.0)) {
        horizontal = half * aspect;
    } else if (axis == "diagonal") {
        horizontal = half * aspect / std::hypot(1.0, aspect);
    } else if (axis != "x" && axis != "smaller" && axis != "larger") {
        fail(where, "unknown fov_axis '" + axis + "'; known ones are x, y, diagonal, smaller, larger");
    }
    return 2.0 * std::atan(horizontal) * kRadian;
}

void apply_sensor(const Object& sensor, Scene& scene, NoteSink& notes) {
    if (sensor.type != "perspective" && sensor.type != "thinlens" && sensor.type != "orthographic") {
        fail_unknown_type(sensor, "perspective, thinlens, orthographic");
    }
    SceneCamera& camera = scene.camera;
    camera.filter = default_filter(kUsualFilter);
    FilmSize film;
    camera.width = film.width;
    camera.height = film.height;
    for (const Object* object : sensor.nested("film")) {
        film = apply_film(*object, camera, notes);
    }
    for (const Object* sampler : sensor.nested("sampler")) {
        scene.samples_per_pixel = whole_number(*sampler, "sample_count", 4, 1, 1 << 24);
    }
    const Mat4 to_world = sensor.transform("to_world");
    const Mat4 unscaled = without_scale(to_world, sensor.where);
    apply_clip(sensor, camera);
    if (sensor.type == "orthographic") {
        camera.kind = CameraKind::orthographic;
        camera.to_world = to_world;
    } else {
        camera.to_world = unscaled;
        camera.fov_x_degrees = read_fov(sensor, static_cast<double>(film.width) / film.height);
        apply_optics(sensor, film, camera);
    }
    for (const Object* medium : sensor.nested("medium")) {
        note(notes, medium->where, kMediaAreLeftOut);
    }
    sensor.ignore({"focus_distance", "shutter_open", "shutter_close", "fov_axis"});
    sensor.report_unused(notes);
}

}  // namespace nearlight::core::mitsuba
