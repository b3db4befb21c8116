// SPDX-License-Identifier: Apache-2.0
#include "host/scene/transmission_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "host/scene/material_model.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

struct Direction {
    double x, y, z;
};

double dot(const Direction& a, const Direction& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

double cosine_of_row(std::size_t i) {
    return static_cast<double>(i) / (NEARLIGHT_CURVE_SIZE - 1);
}

struct Node {
    double x, weight;
};

/// The Gauss-Legendre rule with n nodes on [0, 1].
std::vector<Node> gauss_legendre(int n) {
    std::vector<Node> nodes;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
        double slope = 1.0;
        for (int step = 0; step < 8; ++step) {
            double p0 = 1.0;
            double p1 = x;
            for (int k = 2; k <= n; ++k) {
                p0 = std::exchange(p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k);
            }
            slope = n * (x * p1 - p0) / (x * x - 1.0);
            x -= p1 / slope;
        }
        nodes.push_back({0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)});
    }
    return nodes;
}

/// Isotropic microfacets, as a view in the xz plane meets them.
class Microfacets {
  public:
    Microfacets(double alpha, bool beckmann, int resolution)
        : alpha_(alpha), beckmann_(beckmann), nodes_(gauss_legendre(resolution)) {}

    /// The mean of value(m) over the normals m that are visible from the direction with this cosine.
    template <typename Value>
    [[nodiscard]] double mean(double cosine, const Value& value) const {
        const Direction view{std::sqrt(1.0 - cosine * cosine), 0.0, cosine};
        return beckmann_ ? mean_beckmann(view, value) : mean_ggx(view, value);
    }

    /// Smith's shadowing of a direction; Beckmann's by the rational fit of Walter et al. [2007].
    [[nodiscard]] double shadowing(const Direction& d) const {
        const double tangent = std::sqrt(d.x * d.x + d.y * d.y) / std::abs(d.z);
        if (!beckmann_) {
            return 2.0 / (1.0 + std::hypot(1.0, alpha_ * tangent));
        }
        const double a = 1.0 / (alpha_ * tangent);
        return a >= 1.6 ? 1.0 : (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a);
    }

  private:
    /// Stretched by 1/α, GGX's visible normals are halfway between the view and the directions of a uniformly
    /// lit spherical cap [Dupuy and Benyoub 2023].
    template <typename Value>
    [[nodiscard]] double mean_ggx(const Direction& view, const Value& value) const {
        const double length = std::hypot(alpha_ * view.x, view.z);
        const Direction stretched{alpha_ * view.x / length, 0.0, view.z / length};
        const double opening = std::acos(-stretched.z);
        double sum = 0.0;
        for (const Node& polar : nodes_) {
            const double theta = polar.x * opening;
            const double weight = polar.weight * opening * std::sin(theta) / (1.0 + stretched.z);
            for (const Node& azimuth : nodes_) {  // one half of the cap mirrors the other
                const double phi = azimuth.x * std::numbers::pi;
                const Direction h{std::sin(theta) * std::cos(phi) + stretched.x,
                                  std::sin(theta) * std::sin(phi), std::cos(theta) + stretched.z};
                sum += weight * azimuth.weight * value(view, unit(alpha_ * h.x, alpha_ * h.y, h.z));
            }
        }
        return sum;
    }

    /// Beckmann's slopes are normally distributed, and visible in proportion to their projection.
    template <typename Value>
    [[nodiscard]] double mean_beckmann(const Direction& view, const Value& value) const {
        constexpr double kReach = 4.5;  // in units of α; the rest weighs less than 1e-9
        const double horizon = view.x > 0.0 ? view.z / (view.x * alpha_) : kReach;
        const double end = std::min(kReach, horizon);
        double sum = 0.0;
        double total = 0.0;
        for (const Node& along : nodes_) {
            const double x = -kReach + along.x * (end + kReach);
            const double projection = view.z - alpha_ * x * view.x;
            for (const Node& across : nodes_) {
                const double y = across.x * kReach;
                const double weight = along.weight * across.weight * projection * std::exp(-x * x - y * y);
                sum += weight * value(view, unit(-alpha_ * x, -alpha_ * y, 1.0));
                total += weight;
            }
        }
        return sum / total;
    }

    static Direction unit(double x, double y, double z) {
        const double scale = 1.0 / std::sqrt(x * x + y * y + z * z);
        return {x * scale, y * scale, z * scale};
    }

    double alpha_;
    bool beckmann_;
    std::vector<Node> nodes_;
};

/// What a microfacet lets through, where the refracted direction is not shadowed.
double transmitted(const Microfacets& microfacets, double eta, const Direction& view, const Direction& m) {
    const double cosine = dot(view, m);
    const double cosine2 = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    if (cosine <= 0.0 || cosine2 <= 0.0) {
        return 0.0;
    }
    const double along = cosine / eta - std::sqrt(cosine2);
    const Direction out{along * m.x - view.x / eta, along * m.y - view.y / eta, along * m.z - view.z / eta};
    return out.z < 0.0 ? (1.0 - dielectric_reflectance(cosine, eta)) * microfacets.shadowing(out) : 0.0;
}

/// What a microfacet reflects, where the mirrored direction is not shadowed.
double reflected(const Microfacets& microfacets, double eta, const Direction& view, const Direction& m) {
    const double cosine = dot(view, m);
    const Direction out{2.0 * cosine * m.x - view.x, 2.0 * cosine * m.y - view.y,
                        2.0 * cosine * m.z - view.z};
    return cosine > 0.0 && out.z > 0.0 ? dielectric_reflectance(cosine, eta) * microfacets.shadowing(out)
                                       : 0.0;
}

template <typename Value>
TransmissionCurve make_curve(const Value& value) {
    TransmissionCurve curve{};
    for (std::size_t i = 0; i < curve.size(); ++i) {
        curve[i] = static_cast<float>(value(cosine_of_row(i)));
    }
    return curve;
}

/// Receivers and shared lights keep the number of a curve in 16 bits.
constexpr std::size_t kMaxCurve = 0xffff;
constexpr double kMinCosine = 1e-6;  // a view along the surface has no visible normals

}  // namespace

uint add_curve(Scene& scene, const TransmissionCurve& curve) {
    std::vector<float>& rows = scene.transmission_curves;
    for (std::size_t first = 0; first < rows.size(); first += curve.size()) {
        if (std::equal(curve.begin(), curve.end(), rows.begin() + static_cast<std::ptrdiff_t>(first))) {
            return static_cast<uint>(first / curve.size());
        }
    }
    if (rows.size() / curve.size() > kMaxCurve) {
        throw Error(ErrorKind::out_of_memory,
                    "the scene has more than " + std::to_string(kMaxCurve) +
                        " different coats (index and roughness), which is what receivers "
                        "can tell apart; let materials share them");
    }
    rows.insert(rows.end(), curve.begin(), curve.end());
    return static_cast<uint>(rows.size() / curve.size() - 1);
}

TransmissionCurve smooth_coat_curve(double eta) {
    return make_curve([&](double cosine) { return 1.0 - dielectric_reflectance(cosine, eta); });
}

TransmissionCurve rough_coat_curve(double eta, double alpha, bool beckmann) {
    const Microfacets microfacets(alpha, beckmann, eta > 1.0 ? 32 : 256);
    return make_curve([&](double cosine) {
        return microfacets.mean(std::max(cosine, kMinCosine), [&](const Direction& view, const Direction& m) {
            return transmitted(microfacets, eta, view, m);
        });
    });
}

TransmissionCurve principled_curve() {
    return make_curve([](double cosine) { return 1.0 - 0.5 * std::pow(1.0 - cosine, 5); });
}

double smooth_internal_reflectance(double eta) {
    const double inside = 1.0 / eta;
    if (inside < 1.0) {  // [Egan and Hilgeman 1973]
        return -1.4399 * inside * inside + 0.7099 * inside + 0.6681 + 0.0636 * eta;
    }
    // [d'Eon and Irving 2011]
    return 0.919317 + eta * (-3.4793 + eta * (6.75335 + eta * (-7.80989 + eta * (4.98554 - eta * 1.36881))));
}

double rough_internal_reflectance(double eta, double alpha, bool beckmann) {
    const Microfacets microfacets(alpha, beckmann, eta > 1.0 ? 96 : 32);
    double sum = 0.0;
    for (std::size_t i = 0; i < NEARLIGHT_CURVE_SIZE; ++i) {
        const double cosine = std::max(cosine_of_row(i), kMinCosine);
        sum += cosine * microfacets.mean(cosine, [&](const Direction& view, const Direction& m) {
            return reflected(microfacets, 1.0 / eta, view, m);
        });
    }
    return 2.0 * sum / NEARLIGHT_CURVE_SIZE;
}

}  // namespace nearlight::core
