// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/sky/sky_maker.h"

#include <cmath>

#include "host/scene/mitsuba/sky/sky_model.h"

namespace nearlight::core::mitsuba {
namespace {

constexpr int kSkyWidth = 1024;
constexpr int kSkyHeight = 512;
constexpr double kSunAperture = 0.5358;  // degrees

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
    when.year = static_cast<int>(sky.number("year", when.year));
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
    const Vec3 direction = normalize(transform_vector(
        inverse(to_world), {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])}));
    if (is_zero(direction)) {
        fail(sky.find("sun_direction")->where, "the 'sun_direction' is zero");
    }
    return direction;
}

/// Fills the map with the mean of four points of each pixel; below the horizon it is black. The map's up is
/// +Y, the model's is +Z.
void bake_sky(EnvironmentLight& light, const SkyModel& model, Vec3 sun, float scale) {
    light.width = kSkyWidth;
    light.height = kSkyHeight;
    light.radiance.assign(std::size_t{kSkyWidth} * kSkyHeight, {0, 0, 0});
    for (int row = 0; row < kSkyHeight / 2; ++row) {
        for (int column = 0; column < kSkyWidth; ++column) {
            Vec3 sum{0, 0, 0};
            for (int part = 0; part < 4; ++part) {
                const double theta = std::numbers::pi * (row + 0.25 + 0.5 * (part / 2)) / kSkyHeight;
                const double phi = 2 * std::numbers::pi * (column + 0.25 + 0.5 * (part % 2)) / kSkyWidth;
                // In the map's frame (sin φ·sin θ, cos θ, −cos φ·sin θ), of which −Z is the model's Y.
                const Vec3 direction{static_cast<float>(std::sin(phi) * std::sin(theta)),
                                     static_cast<float>(std::cos(phi) * std::sin(theta)),
                                     static_cast<float>(std::cos(theta))};
                const double gamma =
                    std::acos(std::clamp(static_cast<double>(dot(direction, sun)), -1.0, 1.0));
                sum += model.radiance(std::cos(theta), gamma) * (0.25f * scale);
            }
            light.radiance[static_cast<std::size_t>(row) * kSkyWidth + static_cast<std::size_t>(column)] =
                sum;
        }
    }
}

Vec3 read_albedo(const Object& sky) {
    const std::optional<Color> color = sky.color("albedo");
    const Vec3 albedo = color ? color->reflectance : Vec3{0.3f, 0.3f, 0.3f};
    if (!(min(albedo, {0, 0, 0}) == Vec3{0, 0, 0} && max(albedo, {1, 1, 1}) == Vec3{1, 1, 1})) {
        fail(sky.where, "the 'albedo' of a sky should lie between 0 and 1");
    }
    return albedo;
}

void add_sun(EnvironmentLight& light, const Object& sky, double turbidity, Vec3 sun, double elevation,
             float scale, NoteSink& notes) {
    const double aperture = sky.number("sun_aperture", kSunAperture * sky.number("sun_radius_scale", 1.0));
    if (!(aperture > 0.0 && aperture < 90.0)) {
        fail(sky.where, "the aperture of the sun should be between 0 and 90 degrees");
    }
    if (sky.boolean("complex_sun", false)) {
        note(notes, sky.where, "'complex_sun' is replaced by an even disc of the same power");
    }
    const double half_angle = aperture * std::numbers::pi / 360.0;
    const double solid_angle = 4.0 * std::numbers::pi * std::pow(std::sin(0.5 * half_angle), 2.0);
    light.sun_direction = normalize(transform_vector(light.to_world, {sun.x, sun.z, -sun.y}));
    light.sun_half_angle = static_cast<float>(half_angle);
    light.sun_radiance = sun_irradiance(turbidity, elevation) * (scale / static_cast<float>(solid_angle));
}

}  // namespace

bool is_sky(const Object& emitter) {
    return emitter.type == "sunsky" || emitter.type == "sky" || emitter.type == "sun";
}

EnvironmentLight make_sky(const Object& emitter, NoteSink& notes) {
    const bool is_old = emitter.type != "sunsky";
    const Mat4 to_world = emitter.transform("to_world") * (is_old ? rotation(1, 0, 0, -90) : Mat4{});
    const double turbidity = number_between(emitter, "turbidity", 3.0, 1.0, 10.0);
    const double scale = emitter.number("scale", 1.0);
    const double sky_scale = emitter.type == "sun" ? 0.0 : emitter.number("sky_scale", 1.0) * scale;
    const double sun_scale = emitter.type == "sky" ? 0.0 : emitter.number("sun_scale", 1.0) * scale;
    if (!(sky_scale >= 0.0 && sun_scale >= 0.0)) {
        fail(emitter.where, "the scale of a sky should not be negative");
    }
    if (emitter.number("stretch", 1.0) != 1.0) {
        fail(emitter.where, "a 'stretch' of the sky is not supported");
    }
    emitter.ignore(
        {"resolution", "sun_radius_scale", "sun_aperture", "complex_sun", "sky_scale", "sun_scale"});
    if (is_old) {
        note(notes, emitter.where, "'" + emitter.type + "' is rendered by the model of Mitsuba 3's 'sunsky'");
    }
    const Vec3 sun = local_sun_direction(emitter, to_world);
    const Vec3 albedo = read_albedo(emitter);
    EnvironmentLight light;
    light.to_world = to_world * rotation(1, 0, 0, 90);
    light.width = light.height = 1;
    light.radiance = {{0, 0, 0}};
    if (sun.z < 0.0f) {
        note(notes, emitter.where, "the sun is below the horizon, so the sky is black");
        return light;
    }
    const double elevation = std::asin(std::min(static_cast<double>(sun.z), 1.0));
    if (sky_scale > 0.0) {
        bake_sky(light, SkyModel(turbidity, albedo, elevation), sun, static_cast<float>(sky_scale));
    }
    if (sun_scale > 0.0) {
        add_sun(light, emitter, turbidity, sun, elevation, static_cast<float>(sun_scale), notes);
    }
    return light;
}

}  // namespace nearlight::core::mitsuba
