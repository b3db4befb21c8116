// SPDX-License-Identifier: Apache-2.0
#include "host/reference/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/math.h"

namespace nearlight::core {
namespace {

/// Cells of a filter's table; more than the renderer's, and over both sides.
constexpr int kFilterCells = 4096;

}  // namespace

CameraRays::CameraRays(const SceneCamera& camera, int width, int height)
    : camera_(camera), window_(picture_window(camera, width, height)) {}

Ray CameraRays::through(Point2 film, Point2 lens) const {
    const double x = -(window_.left + window_.pixel * static_cast<double>(film.x));
    const double y = -(window_.top + window_.pixel * static_cast<double>(film.y));
    const auto to_world = [this](double a, double b, double c) {
        return transform_vector(camera_.to_world,
                                {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)});
    };
    Ray ray{.origin = transform_point(camera_.to_world, {0, 0, 0}), .direction = {}};
    if (camera_.kind == CameraKind::orthographic) {
        const Vec3 along = to_world(0, 0, 1);
        ray.origin += to_world(x, y, 0);
        ray.direction = normalize(along);
        ray.t_min = static_cast<float>(camera_.near_clip) * length(along);
        ray.t_max = ray.t_min + static_cast<float>(camera_.far_clip - camera_.near_clip);
        return ray;
    }
    const double radius = camera_.aperture_radius * std::sqrt(static_cast<double>(lens.x));
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(lens.y);
    const double lens_x = radius * std::cos(angle);
    const double lens_y = radius * std::sin(angle);
    // On the plane at the distance 1, this is where the ray from the lens to the point in focus passes by.
    const double focus = camera_.focus_distance;
    const double dx = x - lens_x / focus;
    const double dy = y - lens_y / focus;
    const double stretch = std::sqrt(dx * dx + dy * dy + 1.0);
    ray.origin += to_world(lens_x, lens_y, 0);
    ray.direction = normalize(to_world(dx, dy, 1));
    ray.t_min = static_cast<float>(camera_.near_clip * stretch);
    ray.t_max = static_cast<float>(camera_.far_clip * stretch);
    return ray;
}

FilterSampler::FilterSampler(const SceneCamera& camera, int width, int height)
    : is_box_(is_pixel_box(camera.filter)),
      sample_border_(camera.sample_border),
      radius_(camera.filter.radius),
      width_(width),
      height_(height) {
    const double cell = 2.0 * radius_ / kFilterCells;
    sums_.push_back({});
    for (int i = 0; i < kFilterCells; ++i) {
        const double value = filter_value(camera.filter, -radius_ + (i + 0.5) * cell) * cell;
        sums_.push_back({sums_.back().absolute + std::abs(value), sums_.back().signed_sum + value});
    }
}

FilterSampler::Sums FilterSampler::sums_at(double offset) const {
    const double place = std::clamp((offset + radius_) / (2.0 * radius_), 0.0, 1.0) * kFilterCells;
    const std::size_t cell = std::min(static_cast<std::size_t>(place), sums_.size() - 2);
    const double within = place - static_cast<double>(cell);
    const Sums& from = sums_[cell];
    const Sums& to = sums_[cell + 1];
    return {std::lerp(from.absolute, to.absolute, within), std::lerp(from.signed_sum, to.signed_sum, within)};
}

double FilterSampler::along_axis(double middle, double film_size, double u, double& weight) const {
    const double low = sample_border_ ? -radius_ : std::max(-middle, -radius_);
    const double high = sample_border_ ? radius_ : std::min(film_size - middle, radius_);
    const Sums from = sums_at(low);
    const Sums to = sums_at(high);
    const double wanted = std::lerp(from.absolute, to.absolute, u);
    const auto end = std::clamp(std::ranges::upper_bound(sums_, wanted, {}, &Sums::absolute),
                                sums_.begin() + 1, sums_.end() - 1);
    const auto begin = end - 1;
    const double cell = end->absolute - begin->absolute;
    const double within = cell > 0.0 ? std::clamp((wanted - begin->absolute) / cell, 0.0, 1.0) : 0.5;
    weight *= std::copysign(1.0, end->signed_sum - begin->signed_sum) * (to.absolute - from.absolute) /
              (to.signed_sum - from.signed_sum);
    const double offset =
        (static_cast<double>(begin - sums_.begin()) + within) * 2.0 * radius_ / kFilterCells - radius_;
    return middle + std::clamp(offset, low, high);
}

FilterPoint FilterSampler::sample(int x, int y, Point2 u) const {
    if (is_box_) {
        return {.place = {static_cast<float>(x) + u.x, static_cast<float>(y) + u.y}};
    }
    FilterPoint point;
    point.place.x = static_cast<float>(along_axis(x + 0.5, width_, static_cast<double>(u.x), point.weight));
    point.place.y = static_cast<float>(along_axis(y + 0.5, height_, static_cast<double>(u.y), point.weight));
    return point;
}

}  // namespace nearlight::core
