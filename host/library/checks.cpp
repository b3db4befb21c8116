// SPDX-License-Identifier: Apache-2.0
#include "host/library/checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>

#include "host/base/limits.h"
#include "nearlight/error.h"

namespace nearlight {
namespace {

using core::kMaxFrame;
using core::kMaxLength;
using core::kMaxLightSamples;
using core::kMaxPasses;
using core::kMaxPathDepth;
using core::kMaxPictureSide;
using core::kMaxSamplesPerPixel;
using core::kMaxVpls;

constexpr float kMaxRoulette = 1000.0f;
/// The maximum deviation of a normal's length from 1. Rounding stays below it; a larger deviation means that
/// the normal was not normalised.
constexpr float kNormalTolerance = 1e-3f;

/// Throws unless `value` is in [min, max]. NaN is out of every range.
template <typename Number>
void check_range(std::string_view setting, Number value, Number min, Number max) {
    if (!(value >= min && value <= max)) {
        std::ostringstream text;
        text << setting << " is " << value << "; it must be from " << min << " to " << max;
        throw Error(ErrorKind::invalid_argument, text.str(), setting);
    }
}

template <typename Number>
void check_range(std::string_view setting, const std::optional<Number>& value, Number min, Number max) {
    if (value) {
        check_range(setting, *value, min, max);
    }
}

bool is_unit(Vec3 v) {
    return std::abs(std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z) - 1.0f) <= kNormalTolerance;
}

}  // namespace

void check(const ViewSettings& settings) {
    check_range("width", settings.width, 1, kMaxPictureSide);
    check_range("height", settings.height, 1, kMaxPictureSide);
    check_range("range", settings.range, 1e-6f, kMaxLength);
    check_range("clamp_radius", settings.clamp_radius, 0.0f, kMaxLength);
    check_range("max_depth", settings.max_depth, 1u, kMaxPathDepth);
}

void check(const SamplingSettings& settings) {
    check_range("vpl_count", settings.vpl_count, 0u, kMaxVpls);
    check_range("set_count", settings.set_count, 1u, kMaxVpls);
    check_range("close_fraction", settings.close_fraction, 0.0f, 1.0f);
}

void check(const GatherSettings& settings) {
    check_range("samples_per_pixel", settings.samples_per_pixel, 1u, kMaxSamplesPerPixel);
    check_range("strata", settings.strata, 1u, kMaxSamplesPerPixel);
    check_range("interleave", settings.interleave, 1u, 4u);
    if (settings.interleave == 3) {
        throw Error(ErrorKind::invalid_argument, "interleave is 3; it must be 1, 2 or 4", "interleave");
    }
    check_range("direct_samples_per_pixel", settings.direct_samples_per_pixel, 1u, kMaxLightSamples);
    check_range("rays_per_pixel", settings.rays_per_pixel, 1u, kMaxLightSamples);
    check_range("shared_limit", settings.shared_limit, 0.0f, std::numeric_limits<float>::max());
    check_range("roulette", settings.roulette, 0.0f, kMaxRoulette);
}

void check(const IrradianceSettings& settings) {
    check_range("direct_samples", settings.direct_samples, 1u, kMaxLightSamples);
    check_range("paths", settings.paths, 0u, kMaxSamplesPerPixel);
}

void check(const RenderSettings& settings) {
    check(settings.view);
    check(settings.sampling);
    check(settings.gather);
    check_range("passes", settings.passes, 1u, kMaxPasses);
    check_range("seconds", settings.seconds, 0.0, 1e9);
    check_range("error", settings.error, 1e-5, 100.0);
    for (const std::uint32_t samples : settings.pass_samples) {
        check_range("pass_samples", samples, 1u, kMaxSamplesPerPixel);
    }
}

void check(const AnimationOptions& options) {
    check_range("fps", options.fps, 0.001, 1e6);
    check_range("vpl_keys", options.vpl_keys, 0, kMaxFrame);
}

void check_frame(int frame) {
    check_range("frame", frame, 0, kMaxFrame);
}

void check_values(const std::string& problem, const Image& image) {
    const std::size_t count = static_cast<std::size_t>(std::max(image.width, 0)) *
                              static_cast<std::size_t>(std::max(image.height, 0)) * image.channels.size();
    if (image.values.size() != count) {
        throw Error(ErrorKind::invalid_argument,
                    problem + ": the image has " + std::to_string(image.values.size()) +
                        " values, which is not its width times its height times its channels");
    }
}

void check_points(std::span<const Vec3> points, std::span<const Vec3> normals) {
    if (points.size() != normals.size()) {
        throw Error(ErrorKind::invalid_argument,
                    std::to_string(points.size()) + " points need as many normals as points, not " +
                        std::to_string(normals.size()),
                    "normals");
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (!std::isfinite(points[i].x + points[i].y + points[i].z)) {
            throw Error(ErrorKind::invalid_argument,
                        "point " + std::to_string(i) + " has a number that is not finite", "points");
        }
        if (!is_unit(normals[i])) {
            throw Error(ErrorKind::invalid_argument,
                        "normal " + std::to_string(i) + " does not have length 1; normalise it", "normals");
        }
    }
}

}  // namespace nearlight
