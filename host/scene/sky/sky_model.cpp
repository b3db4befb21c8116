// SPDX-License-Identifier: Apache-2.0
#include "host/scene/sky/sky_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/sky/sky_data.h"

namespace nearlight::core {
namespace {

// Mitsuba's radiance is divided by the integral of the standard observer's y.
constexpr double kSkyScale = 1.0 / 106.7502593994140625;

/// Where a value lies between two entries of a table.
struct Between {
    int low;
    double t;

    Between(double place, int entries)
        : low(std::clamp(static_cast<int>(place), 0, entries - 2)), t(std::clamp(place - low, 0.0, 1.0)) {}
    [[nodiscard]] double mix(double a, double b) const { return a * (1.0 - t) + b * t; }
};

/// An entry of a table by turbidity, albedo and control point, interpolated over all of them. `stride` is the
/// number of entries of a control point.
double sky_entry(const float* table, int stride, int entry, double turbidity, double albedo,
                 double elevation) {
    constexpr double kBinomials[kSkyControlPoints] = {1, 5, 10, 10, 5, 1};
    const Between by_turbidity(turbidity - 1.0, kSkyTurbidities);
    const double x = std::min(std::cbrt(2.0 * elevation / std::numbers::pi), 1.0 - 1e-7);
    const auto value = [&](int t, int a, int point) {
        return static_cast<double>(
            table[((t * kSkyAlbedos + a) * kSkyControlPoints + point) * stride + entry]);
    };
    double sum = 0.0;
    for (int point = 0; point < kSkyControlPoints; ++point) {
        const auto at_turbidity = [&](int t) {
            return value(t, 0, point) * (1.0 - albedo) + value(t, 1, point) * albedo;
        };
        sum += kBinomials[point] * std::pow(x, point) * std::pow(1.0 - x, kSkyControlPoints - 1 - point) *
               by_turbidity.mix(at_turbidity(by_turbidity.low), at_turbidity(by_turbidity.low + 1));
    }
    return sum;
}

}  // namespace

SkyModel::SkyModel(double turbidity, Vec3 albedo, double sun_elevation) {
    const std::array<float, 3> albedos{albedo.x, albedo.y, albedo.z};
    for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        mean_[channel] = sky_entry(kSkyRadiance, 3, c, turbidity, albedos[channel], sun_elevation);
        for (int p = 0; p < kSkyModelParameters; ++p) {
            parameters_[channel][static_cast<std::size_t>(p)] =
                sky_entry(kSkyParameters, 3 * kSkyModelParameters, c * kSkyModelParameters + p, turbidity,
                          albedos[channel], sun_elevation);
        }
    }
}

Vec3 SkyModel::radiance(double cos_zenith, double gamma) const {
    const double cos_gamma = std::cos(gamma);
    const auto channel = [&](std::size_t c) {
        const std::array<double, 9>& p = parameters_[c];
        const double glow =
            (1.0 + cos_gamma * cos_gamma) / std::pow(1.0 + p[8] * p[8] - 2.0 * p[8] * cos_gamma, 1.5);
        const double horizon = 1.0 + p[0] * std::exp(p[1] / (cos_zenith + 0.01));
        const double sun = p[2] + p[3] * std::exp(p[4] * gamma) + p[5] * cos_gamma * cos_gamma + p[6] * glow +
                           p[7] * std::sqrt(std::max(0.0, cos_zenith));
        return static_cast<float>(std::max(0.0, horizon * sun * mean_[c] * kSkyScale));
    };
    return {channel(0), channel(1), channel(2)};
}

Vec3 sun_irradiance(double turbidity, double sun_elevation) {
    const Between by_turbidity(turbidity - 1.0, kSkyTurbidities);
    const Between by_elevation((sun_elevation * 180.0 / std::numbers::pi - 2.0) / 3.0, kSunElevations);
    const auto channel = [&](int c) {
        const auto at = [&](int t) {
            const auto value = [&](int e) {
                return static_cast<double>(kSunIrradiance[(t * kSunElevations + e) * 3 + c]);
            };
            return by_elevation.mix(value(by_elevation.low), value(by_elevation.low + 1));
        };
        return static_cast<float>(
            std::max(0.0, by_turbidity.mix(at(by_turbidity.low), at(by_turbidity.low + 1))));
    };
    return {channel(0), channel(1), channel(2)};
}

Vec3 sun_direction(const PlaceAndTime& when) {
    const double radian = std::numbers::pi / 180.0;
    // Days since noon of 1 January 2000, Universal Time.
    const double hours = when.hour - when.timezone + (when.minute + when.second / 60.0) / 60.0;
    const int early = (when.month - 14) / 12;
    const int julian = 1461 * (when.year + 4800 + early) / 4 + 367 * (when.month - 2 - 12 * early) / 12 -
                       3 * ((when.year + 4900 + early) / 100) / 4 + when.day - 32075;
    const double days = julian - 0.5 + hours / 24.0 - 2451545.0;

    const double node = 2.1429 - 0.0010394594 * days;
    const double anomaly = 6.2400600 + 0.0172019699 * days;
    const double longitude = 4.8950630 + 0.017202791698 * days + 0.03341607 * std::sin(anomaly) +
                             0.00034894 * std::sin(2 * anomaly) - 0.0001134 - 0.0000203 * std::sin(node);
    const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(node);
    const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
    const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));

    const double sidereal_hours = 6.6974243242 + 0.0657098283 * days + hours;
    const double hour_angle = (sidereal_hours * 15.0 + when.longitude) * radian - right_ascension;
    const double latitude = when.latitude * radian;
    double zenith = std::acos(std::cos(latitude) * std::cos(hour_angle) * std::cos(declination) +
                              std::sin(declination) * std::sin(latitude));
    const double azimuth = std::atan2(-std::sin(hour_angle), std::tan(declination) * std::cos(latitude) -
                                                                 std::sin(latitude) * std::cos(hour_angle)) -
                           std::numbers::pi;
    constexpr double kParallax = 6371.01 / 149597890.0;  // Earth's radius in astronomical units
    zenith += kParallax * std::sin(zenith);
    return {static_cast<float>(std::sin(zenith) * std::cos(azimuth)),
            static_cast<float>(std::sin(zenith) * std::sin(azimuth)), static_cast<float>(std::cos(zenith))};
}

}  // namespace nearlight::core
