// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/sensor_maker.h"

#include <numbers>

#include "host/scene/mitsuba/values.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr double kRadian = 180.0 / std::numbers::pi;
constexpr int kMaxSide = 1 << 16;

int positive_integer(const Object& object, const char* name, int fallback, int max_value) {
    const double value = object.number(name, fallback);
    if (!(value >= 1.0 && value <= max_value)) {
        fail(object.find(name)->where,
             std::string("'") + name + "' should be from 1 to " + std::to_string(max_value));
    }
    return static_cast<int>(value);
}

void apply_film(const Object& film, SceneCamera& camera, NoteSink& notes) {
    if (film.type != "hdrfilm" && film.type != "ldrfilm" && film.type != "specfilm") {
        fail_unknown_type(film, "hdrfilm, ldrfilm");
    }
    camera.width = positive_integer(film, "width", 768, kMaxSide);
    camera.height = positive_integer(film, "height", 576, kMaxSide);
    for (const char* crop : {"crop_width", "crop_height", "crop_offset_x", "crop_offset_y"}) {
        if (film.has(crop)) {
            note(notes, film.find(crop)->where, "the film's crop is ignored; the whole picture is rendered");
        }
    }
}

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

}  // namespace

double read_fov(const Object& owner, double aspect) {
    owner.ignore({"fov_axis"});
    if (!owner.has("fov")) {
        return horizontal_fov(fov_of_focal_length(owner), "diagonal", aspect, owner.where);
    }
    const double fov = owner.number("fov", 0.0);
    if (!(fov > 0.0 && fov < 180.0)) {
        fail(owner.find("fov")->where, "'fov' should be between 0 and 180");
    }
    return horizontal_fov(fov, owner.string("fov_axis", "x"), aspect, owner.where);
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
    if (sensor.type == "thinlens") {
        note(notes, sensor.where, "'thinlens' is replaced by a pinhole camera; everything is in focus");
        sensor.ignore({"aperture_radius", "focus_distance"});
    } else if (sensor.type != "perspective") {
        fail_unknown_type(sensor, "perspective, thinlens");
    }
    sensor.ignore({"near_clip", "far_clip", "focus_distance", "shutter_open", "shutter_close", "fov_axis"});
    scene.camera.width = 768;
    scene.camera.height = 576;
    for (const Object* film : sensor.nested("film")) {
        apply_film(*film, scene.camera, notes);
    }
    for (const Object* sampler : sensor.nested("sampler")) {
        scene.samples_per_pixel = positive_integer(*sampler, "sample_count", 4, 1 << 24);
    }
    scene.camera.to_world = without_scale(sensor.transform("to_world"), sensor.where);
    scene.camera.fov_x_degrees =
        read_fov(sensor, static_cast<double>(scene.camera.width) / scene.camera.height);
    if (sensor.has("principal_point_offset_x") || sensor.has("principal_point_offset_y")) {
        note(notes, sensor.where,
             "the sensor's principal point is ignored; the middle of the picture is used");
        sensor.ignore({"principal_point_offset_x", "principal_point_offset_y"});
    }
    sensor.report_unused(notes);
}

}  // namespace nearlight::core::mitsuba
