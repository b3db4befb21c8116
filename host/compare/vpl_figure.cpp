// SPDX-License-Identifier: Apache-2.0
#include "host/compare/vpl_figure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/compare/pictures.h"
#include "host/scene/camera.h"

namespace nearlight::core {
namespace {

/// Approximate minimum width (pixels) of the picture that dots are drawn into.
constexpr int kDrawingWidth = 640;
constexpr float kDimming = 0.45f;
/// Maximum ratio of a visible VPL's distance to the depth of its pixel, which is known at the pixel's centre
/// only.
constexpr float kDepthTolerance = 1.02f;

struct Pen {
    Vec3 color;
    float radius = 0;  ///< pixels of the drawing
    float opacity = 0;
};

Pen pen_for(bool close, bool visible) {
    const Vec3 color = close ? Vec3{1.0f, 0.30f, 0.02f} : Vec3{0.05f, 0.45f, 1.0f};
    return visible ? Pen{color, 1.8f, 1.0f} : Pen{color, 1.3f, 0.4f};
}

void draw_disc(Image& picture, float center_x, float center_y, const Pen& pen) {
    const int reach = static_cast<int>(std::ceil(pen.radius)) + 1;
    for (int y = static_cast<int>(center_y) - reach; y <= static_cast<int>(center_y) + reach; ++y) {
        for (int x = static_cast<int>(center_x) - reach; x <= static_cast<int>(center_x) + reach; ++x) {
            if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) {
                continue;
            }
            const float distance =
                std::hypot(static_cast<float>(x) + 0.5f - center_x, static_cast<float>(y) + 0.5f - center_y);
            const float cover = pen.opacity * std::clamp(pen.radius + 0.5f - distance, 0.0f, 1.0f);
            const float color[3] = {pen.color.x, pen.color.y, pen.color.z};
            for (std::size_t c = 0; c < 3; ++c) {
                picture.at(x, y, c) += cover * (color[c] - picture.at(x, y, c));
            }
        }
    }
}

/// Whether nothing is in front of the point, according to the depths around its pixel.
bool is_visible(const FilmPoint& point, std::span<const float> depths, int width, int height) {
    float farthest = 0.0f;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const int x = std::clamp(static_cast<int>(point.x) + dx, 0, width - 1);
            const int y = std::clamp(static_cast<int>(point.y) + dy, 0, height - 1);
            farthest =
                std::max(farthest, depths[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                          static_cast<std::size_t>(x)]);
        }
    }
    return farthest == 0.0f || point.distance <= farthest * kDepthTolerance;
}

}  // namespace

std::optional<FilmPoint> project(const SceneCamera& camera, Vec3 point) {
    const std::optional<FilmPosition> position = film_position(camera, point);
    if (!position) {
        return std::nullopt;
    }
    const auto width = static_cast<float>(camera.width);
    const auto height = static_cast<float>(camera.height);
    const FilmPoint film{static_cast<float>(position->x), static_cast<float>(position->y),
                         static_cast<float>(position->distance)};
    const bool inside = film.x >= 0.0f && film.x < width && film.y >= 0.0f && film.y < height;
    return inside ? std::optional(film) : std::nullopt;
}

VplDots draw_vpls(const Image& overview, std::span<const float> depths, const SceneCamera& camera,
                  std::span<const Vpl> vpls) {
    const int factor = std::max(1, kDrawingWidth / overview.width);
    VplDots dots{.picture = enlarged(scaled(overview, kDimming * display_scale(overview)), factor),
                 .vpls = vpls.size()};
    for (float& value : dots.picture.values) {
        value = std::min(value, 1.0f);
    }
    for (const bool front : {false, true}) {  // hidden VPLs come first, so that they cover no visible ones
        for (const Vpl& vpl : vpls) {
            const std::optional<FilmPoint> point = project(camera, vpl.position);
            if (!point || is_visible(*point, depths, overview.width, overview.height) != front) {
                continue;
            }
            ++dots.in_picture;
            dots.visible += front ? 1 : 0;
            const auto scale = static_cast<float>(factor);
            draw_disc(dots.picture, point->x * scale, point->y * scale,
                      pen_for((vpl.flags & NEARLIGHT_VPL_CLOSE) != 0, front));
        }
    }
    return dots;
}

}  // namespace nearlight::core
