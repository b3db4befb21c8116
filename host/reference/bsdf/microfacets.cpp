// SPDX-License-Identifier: Apache-2.0
#include "host/reference/bsdf/microfacets.h"

#include <limits>
#include <numbers>

namespace nearlight::core {
namespace {

constexpr double kMicrofacetPi = std::numbers::pi;
constexpr double kMinMicrofacetAlpha = 1e-4;

double squared(double x) {
    return x * x;
}

/// Solves f(x) = 0 for an f that rises between low and high, by Newton's steps, halving where one leaves the
/// bracket. `f` returns the value and the derivative.
template <typename Function>
double solve_rising(double low, double high, double start, const Function& f) {
    double x = start;
    for (int i = 0; i < 100 && high - low > 1e-15; ++i) {
        const auto [value, slope] = f(x);
        (value < 0 ? low : high) = x;
        const double next = slope > 0 ? x - value / slope : low;
        const double old = x;
        x = next > low && next < high ? next : 0.5 * (low + high);
        if (std::abs(x - old) < 1e-14 * (1 + std::abs(x))) {
            break;
        }
    }
    return x;
}

struct ValueAndSlope {
    double value, slope;
};

double inverse_erf(double y) {
    return solve_rising(-6.0, 6.0, 0.0, [y](double x) {
        return ValueAndSlope{std::erf(x) - y, 2 / std::sqrt(kMicrofacetPi) * std::exp(-x * x)};
    });
}

struct Slopes {
    double x, y;
};

/// Slopes of Beckmann microfacets with α = 1 that are seen at the angle θ. The slope x has the density
/// (cosθ − x·sinθ)·exp(−x²) up to cotθ, whose integral is known; y is independent of it.
Slopes sample_beckmann_slopes(double cosine, double u, double v) {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const auto below = [&](double x) {
        return 0.5 * cosine * (1 + std::erf(x)) + 0.5 * sine / std::sqrt(kMicrofacetPi) * std::exp(-x * x);
    };
    const double limit = std::min(6.0, cosine / std::max(sine, 1e-12));
    const double wanted = u * below(limit);
    const double x = solve_rising(-6.0, limit, std::min(0.0, limit - 1e-3), [&](double s) {
        return ValueAndSlope{below(s) - wanted,
                             (cosine - s * sine) * std::exp(-s * s) / std::sqrt(kMicrofacetPi)};
    });
    return {x, inverse_erf(2 * std::clamp(v, 1e-12, 1 - 1e-12) - 1)};
}

/// A visible normal of a hemisphere, seen from the unit vector w [Heitz, Sampling the GGX Distribution of
/// Visible Normals, JCGT 2018].
Vec3d sample_hemisphere_normal(Vec3d w, double u, double v) {
    Vec3d across = cross(Vec3d{0, 0, 1}, w);
    across = length(across) > 1e-12 ? normalize(across) : Vec3d{1, 0, 0};
    const Vec3d up = cross(w, across);
    const double radius = std::sqrt(u);
    const double x = radius * std::cos(2 * kMicrofacetPi * v);
    const double squeeze = 0.5 * (1 + w.z);
    const double y = (1 - squeeze) * std::sqrt(std::max(0.0, 1 - x * x)) +
                     squeeze * radius * std::sin(2 * kMicrofacetPi * v);
    return across * x + up * y + w * std::sqrt(std::max(0.0, 1 - x * x - y * y));
}

}  // namespace

Microfacets::Microfacets(bool beckmann, double alpha_x, double alpha_y)
    : beckmann_(beckmann),
      alpha_x_(std::max(alpha_x, kMinMicrofacetAlpha)),
      alpha_y_(std::max(alpha_y, kMinMicrofacetAlpha)) {}

double Microfacets::density(Vec3d m) const {
    if (m.z <= 0) {
        return 0;
    }
    const double stretched = squared(m.x / alpha_x_) + squared(m.y / alpha_y_);
    const double norm = kMicrofacetPi * alpha_x_ * alpha_y_;
    if (beckmann_) {
        return std::exp(-stretched / squared(m.z)) / (norm * squared(squared(m.z)));
    }
    return 1 / (norm * squared(stretched + squared(m.z)));
}

double Microfacets::steepness(Vec3d w) const {
    const double across = std::sqrt(squared(alpha_x_ * w.x) + squared(alpha_y_ * w.y));
    return across > 0 ? std::abs(w.z) / across : std::numeric_limits<double>::infinity();
}

double Microfacets::masking(Vec3d w, Vec3d m) const {
    if (dot(w, m) * w.z <= 0) {
        return 0;
    }
    if (!beckmann_) {
        return exact_masking(w);
    }
    const double a = steepness(w);
    return a >= 1.6 ? 1 : (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a);
}

double Microfacets::exact_masking(Vec3d w) const {
    const double a = steepness(w);
    if (beckmann_) {
        const double tail = std::exp(-a * a) / (a * std::sqrt(kMicrofacetPi));
        return a > 0 ? 2 / (1 + std::erf(a) + tail) : 0;
    }
    return 2 / (1 + std::sqrt(1 + 1 / (a * a)));
}

Vec3d Microfacets::sample_visible(Vec3d w, double u, double v) const {
    const Vec3d stretched = normalize(Vec3d{alpha_x_ * w.x, alpha_y_ * w.y, w.z});
    if (!beckmann_) {
        const Vec3d n = sample_hemisphere_normal(stretched, u, v);
        return normalize(Vec3d{alpha_x_ * n.x, alpha_y_ * n.y, std::max(1e-12, n.z)});
    }
    const auto [along, beside] = sample_beckmann_slopes(stretched.z, u, v);
    const double horizontal = std::sqrt(squared(stretched.x) + squared(stretched.y));
    const double cos_phi = horizontal > 0 ? stretched.x / horizontal : 1;
    const double sin_phi = horizontal > 0 ? stretched.y / horizontal : 0;
    const double slope_x = alpha_x_ * (cos_phi * along - sin_phi * beside);
    const double slope_y = alpha_y_ * (sin_phi * along + cos_phi * beside);
    return normalize(Vec3d{-slope_x, -slope_y, 1});
}

double Microfacets::visible_density(Vec3d w, Vec3d m) const {
    const double cosine = dot(w, m);
    return cosine > 0 && w.z > 0 ? exact_masking(w) * cosine * density(m) / w.z : 0;
}

}  // namespace nearlight::core
