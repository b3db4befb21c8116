// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/sky_maker.h"

#include <cmath>

#include "host/scene/sky/sky_light.h"
#include "host/scene/sky/sky_model.h"

namespace nearlight::core::mitsuba {
namespace {

double number_between(const Object& sky, const char* name, double fallback, double low, double high) {
    const double value = sky.number(name, fallback);
    if (!(value >= low && value <= high)) {
        fail(sky.find(name)->where, std::string("'") + name + "' should be from " +
                                        std::to_string(static_cast<int>(low)) + " to " +
                                        std::to_string(static_cast<int>(high)));
    }
    return value;
}

PlaceAndTime read_place_and_time(const Object& sky) {
    PlaceAndTime when;
    when.latitude = sky.number("latitude", when.latitude);
    when.longitude = sky.number("longitude", when.longitude);
    when.timezone = sky.number("timezone", when.timezone);
    when.year = static_cast<int>(number_between(sky, "year", when.year, 1, 9999));
    when.month = static_cast<int>(number_between(sky, "month", when.month, 1, 12));
    when.day = static_cast<int>(number_between(sky, "day", when.day, 1, 31));
    when.hour = sky.number("hour", when.hour);
    when.minute = sky.number("minute", when.minute);
    when.second = sky.number("second", when.second);
    return when;
}

/// The direction to the sun in the frame of the sky, whose transform to the world is given.
Vec3 local_sun_direction(const Object& sky, const Mat4& to_world) {
    if (!sky.has("sun_direction")) {
        return sun_direction(read_place_and_time(sky));
    }
    for (const char* name :
         {"latitude", "longitude", "timezone", "year", "month", "day", "hour", "minute", "second"}) {
        if (sky.has(name)) {
            fail(sky.find(name)->where, "a sky has either 'sun_direction' or a place and time");
        }
    }
    const Triple d = sky.triple("sun_direction", {0, 0, 1});
    if (linear_determinant(to_world) == 0.0) {
        fail(sky.where,
             "the transform of this sky is singular: it maps space onto a plane, a line or a point");
    }
    const Vec3 direction = normalize(transform_vector(
        inverse(to_world), {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])}));
    if (is_zero(direction)) {
        fail(sky.find("sun_direction")->where, "the 'sun_direction' is zero");
    }
    return direction;
}

Vec3 read_albedo(const Object& sky, float fallback) {
    const std::optional<Color> color = sky.color("albedo");
    const Vec3 albedo = color ? color->reflectance : Vec3{1, 1, 1} * fallback;
    if (!(min(albedo, {0, 0, 0}) == Vec3{0, 0, 0} && max(albedo, {1, 1, 1}) == Vec3{1, 1, 1})) {
        fail(sky.where, "the 'albedo' of a sky should lie between 0 and 1");
    }
    return albedo;
}

/// What multiplies the light of the sky and that of the sun.
struct SkyScales {
    double sky = 0.0, sun = 0.0;
};

/// Mitsuba 0.5 and 0.6 take `scale` where a part has no scale of its own; Mitsuba 3 multiplies the two.
SkyScales read_scales(const Object& emitter, bool is_old) {
    const double scale = emitter.number("scale", 1.0);
    const auto scale_of = [&](const char* name) {
        return is_old ? emitter.number(name, scale) : scale * emitter.number(name, 1.0);
    };
    SkyScales scales;
    scales.sky = emitter.type == "sun" ? 0.0 : scale_of("sky_scale");
    scales.sun = emitter.type == "sky" ? 0.0 : scale_of("sun_scale");
    if (!(scales.sky >= 0.0 && scales.sun >= 0.0)) {
        fail(emitter.where, "the scale of a sky should not be negative");
    }
    return scales;
}

/// Half the angle under which the sun is seen, radians.
double read_sun_half_angle(const Object& sky, NoteSink& notes) {
    const double aperture = sky.number("sun_aperture", kSunAperture * sky.number("sun_radius_scale", 1.0));
    if (!(aperture > 0.0 && aperture < 90.0)) {
        fail(sky.where, "the aperture of the sun should be between 0 and 90 degrees");
    }
    if (sky.boolean("complex_sun", false)) {
        note(notes, sky.where, "'complex_sun' is replaced by an even disc of the same power");
    }
    return aperture * std::numbers::pi / 360.0;
}

}  // namespace

bool is_sky(const Object& emitter) {
    return emitter.type == "sunsky" || emitter.type == "sky" || emitter.type == "sun";
}

EnvironmentLight make_sky(const Object& emitter, NoteSink& notes) {
    const bool is_old = emitter.is_old || emitter.type != "sunsky";
    const Mat4 to_world = emitter.transform("to_world") * (is_old ? rotation(1, 0, 0, -90) : Mat4{});
    const double turbidity = number_between(emitter, "turbidity", 3.0, 1.0, 10.0);
    const SkyScales scales = read_scales(emitter, is_old);
    if (emitter.number("stretch", 1.0) != 1.0) {
        fail(emitter.where, "a 'stretch' of the sky is not supported");
    }
    emitter.ignore(
        {"resolution", "sun_radius_scale", "sun_aperture", "complex_sun", "sky_scale", "sun_scale"});
    if (is_old) {
        note(notes, emitter.where,
             "'" + emitter.type +
                 "' of Mitsuba 0.5 is rendered by the model of Mitsuba 3's 'sunsky', with +Y up");
    }
    const Vec3 sun = local_sun_direction(emitter, to_world);
    const Vec3 albedo = read_albedo(emitter, is_old ? 0.2f : 0.3f);
    EnvironmentLight light;
    light.to_world = to_world * sky_map_to_model();
    light.width = light.height = 1;
    light.radiance = {{0, 0, 0}};
    if (sun.z < 0.0f) {
        note(notes, emitter.where, "the sun is below the horizon, so the sky is black");
        return light;
    }
    SkyLight sky{.turbidity = turbidity,
                 .albedo = albedo,
                 .sun = sun,
                 .sky_scale = scales.sky,
                 .sun_scale = scales.sun};
    if (scales.sun > 0.0) {
        sky.sun_half_angle = read_sun_half_angle(emitter, notes);
    }
    set_sky(light, sky);
    return light;
}

}  // namespace nearlight::core::mitsuba
