// SPDX-License-Identifier: Apache-2.0
#include "host/scene/transmission_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
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

/// Mitsuba's tables have so many values, at equal steps of the cosine.
constexpr std::size_t kTableSize = 64;
constexpr std::size_t kStepsPerTableStep = 4;
static_assert((kTableSize - 1) * kStepsPerTableStep + 1 == NEARLIGHT_CURVE_SIZE);

double table_cosine(std::size_t i) {
    return static_cast<double>(i) / (kTableSize - 1);
}

struct Node {
    double x, weight;
};

constexpr double kMaxSlope = 6.0;  // in units of α; beyond it there are 1e-16 of Beckmann's slopes

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

/// The slope s below `max_slope` at which 1 + erf(s) + tangent/√π · exp(−s²), which grows up to s = 1 ÷
/// tangent, is the part u of what it is at `max_slope`.
double slope_of_part(double u, double tangent, double max_slope) {
    const auto grown = [&](double s) {
        return 1.0 + std::erf(s) + tangent * std::numbers::inv_sqrtpi * std::exp(-s * s);
    };
    const double wanted = u * grown(max_slope);
    double low = -kMaxSlope;
    double high = max_slope;
    for (int step = 0; step < 44; ++step) {
        const double middle = 0.5 * (low + high);
        (grown(middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Isotropic microfacets, as a view in the xz plane meets them. Means over them are the sums of Mitsuba's
/// `roughplastic`: its nodes in the unit square, from which visible normals are drawn, and not only its
/// integral. With 32 × 32 nodes the sum is up to 0.03 % above the integral, which shows where light meets
/// coats many times.
class Microfacets {
  public:
    Microfacets(double alpha, bool beckmann, int resolution)
        : alpha_(alpha), beckmann_(beckmann), nodes_(gauss_legendre(resolution)) {
        for (const Node& u : right_half()) {
            if (beckmann) {
                across_.push_back({slope_of_part(u.x, 0.0, kMaxSlope), 2.0 * u.weight});
                continue;
            }
            for (const Node& v : nodes_) {
                disk_.push_back(disk_point(2.0 * u.x - 1.0, 2.0 * v.x - 1.0, 2.0 * u.weight * v.weight));
            }
        }
    }

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
    struct DiskPoint {
        double x, y, weight;
    };

    /// The concentric map of the square [−1, 1]², here for x > 0. [Shirley & Chiu, A Low Distortion Map
    /// Between Disk and Square, 1997]
    static DiskPoint disk_point(double x, double y, double weight) {
        constexpr double kEighthTurn = 0.25 * std::numbers::pi;
        if (x >= std::abs(y)) {
            const double angle = kEighthTurn * y / x;
            return {x * std::cos(angle), x * std::sin(angle), weight};
        }
        const double angle = kEighthTurn * x / y;
        return {y * std::sin(angle), y * std::cos(angle), weight};
    }

    /// The nodes above 1/2. The others mirror them, and their normals bring the same by symmetry.
    [[nodiscard]] std::span<const Node> right_half() const {
        return std::span(nodes_).first(nodes_.size() / 2);
    }

    /// Stretched by 1/α, GGX's visible normals are those of a hemisphere, projected along the view. [Heitz,
    /// Sampling the GGX Distribution of Visible Normals, JCGT 2018]
    template <typename Value>
    [[nodiscard]] double mean_ggx(const Direction& view, const Value& value) const {
        const double length = std::hypot(alpha_ * view.x, view.z);
        const Direction stretched{alpha_ * view.x / length, 0.0, view.z / length};
        const double lower_part = 0.5 * (1.0 + stretched.z);
        double sum = 0.0;
        for (const DiskPoint& point : disk_) {
            const double rim = std::sqrt(std::max(0.0, 1.0 - point.x * point.x));
            const double y = rim + lower_part * (point.y - rim);
            const double z = std::sqrt(std::max(0.0, rim * rim - y * y));
            const Direction h{z * stretched.x - y * stretched.z, point.x, z * stretched.z + y * stretched.x};
            sum += point.weight * value(view, unit(alpha_ * h.x, alpha_ * h.y, h.z));
        }
        return sum;
    }

    /// Beckmann's slopes are normally distributed, and visible in proportion to their projection.
    template <typename Value>
    [[nodiscard]] double mean_beckmann(const Direction& view, const Value& value) const {
        const double tangent = alpha_ * view.x / view.z;
        const double horizon = tangent * kMaxSlope > 1.0 ? 1.0 / tangent : kMaxSlope;
        double sum = 0.0;
        for (const Node& u : nodes_) {
            const double x = slope_of_part(u.x, tangent, horizon);
            for (const Node& y : across_) {
                sum += u.weight * y.weight * value(view, unit(-alpha_ * x, -alpha_ * y.x, 1.0));
            }
        }
        return sum;
    }

    static Direction unit(double x, double y, double z) {
        const double scale = 1.0 / std::sqrt(x * x + y * y + z * z);
        return {x * scale, y * scale, z * scale};
    }

    double alpha_;
    bool beckmann_;
    std::vector<Node> nodes_;      // from 1 down to 0, an even number
    std::vector<Node> across_;     // Beckmann's slopes across the plane of the view, one half of them
    std::vector<DiskPoint> disk_;  // GGX's points for the right half of the square
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
        curve[i] = static_cast<float>(value(static_cast<double>(i) / (NEARLIGHT_CURVE_SIZE - 1)));
    }
    return curve;
}

/// The curve that is linear between the values of a table of Mitsuba's.
template <typename Value>
TransmissionCurve make_table(const Value& value) {
    TransmissionCurve curve{};
    double from = value(table_cosine(0));
    for (std::size_t i = 0; i + 1 < kTableSize; ++i) {
        const double to = value(table_cosine(i + 1));
        for (std::size_t step = 0; step <= kStepsPerTableStep; ++step) {
            const double part = static_cast<double>(step) / kStepsPerTableStep;
            curve[i * kStepsPerTableStep + step] = static_cast<float>(std::lerp(from, to, part));
        }
        from = to;
    }
    return curve;
}

/// What sheen 1 reflects of light that comes in at this cosine: ∫ (1 − ωi·m)⁵ cosθi dωi, with m halfway
/// between the directions [Burley 2012], by the rule of the midpoints.
double sheen_albedo(double cosine) {
    constexpr int kHeights = 32;
    constexpr int kAngles = 32;
    const Direction from{std::sqrt(1.0 - cosine * cosine), 0.0, cosine};
    double sum = 0.0;
    for (int i = 0; i < kHeights; ++i) {
        const double height = std::sqrt((i + 0.5) / kHeights);  // cosine-distributed
        const double sine = std::sqrt(1.0 - height * height);
        for (int k = 0; k < kAngles; ++k) {
            const double angle = std::numbers::pi * (k + 0.5) / kAngles;
            const double between = from.x * sine * std::cos(angle) + from.z * height;
            // The half vector makes half the angle between the directions with either.
            sum += std::pow(1.0 - std::sqrt(0.5 * (1.0 + between)), 5);
        }
    }
    return std::numbers::pi * sum / (kHeights * kAngles);
}

/// The nodes along each side of the square, as many as Mitsuba has, for light that comes in where eta is the
/// index beyond the coat ÷ that before it.
int resolution(double eta) {
    return eta > 1.0 ? 32 : 128;
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
                        " different coats (index, roughness, clearcoat and sheen), which is what "
                        "receivers can tell apart; let materials share them");
    }
    rows.insert(rows.end(), curve.begin(), curve.end());
    return static_cast<uint>(rows.size() / curve.size() - 1);
}

TransmissionCurve smooth_coat_curve(double eta) {
    return make_curve([&](double cosine) { return 1.0 - dielectric_reflectance(cosine, eta); });
}

TransmissionCurve rough_coat_curve(double eta, double alpha, bool beckmann) {
    const Microfacets microfacets(alpha, beckmann, resolution(eta));
    return make_table([&](double cosine) {
        return microfacets.mean(std::max(cosine, kMinCosine), [&](const Direction& view, const Direction& m) {
            return transmitted(microfacets, eta, view, m);
        });
    });
}

TransmissionCurve principled_curve() {
    return make_curve([](double cosine) { return 1.0 - 0.5 * std::pow(1.0 - cosine, 5); });
}

TransmissionCurve layered_curve(const Layers& layers) {
    constexpr int kNodes = 64;
    const double alpha = layers.roughness * layers.roughness;
    const Microfacets microfacets(std::max(alpha, static_cast<double>(NEARLIGHT_MIN_ALPHA)), false, kNodes);
    TransmissionCurve curve = make_table([&](double cosine) {
        const double facets =
            microfacets.mean(std::max(cosine, kMinCosine), [&](const Direction& view, const Direction& m) {
                return reflected(microfacets, layers.eta, view, m);
            });
        // Disney's clearcoat is not divided by the cosines, so that it fades towards the horizon.
        const double coat =
            layers.clearcoat * std::lerp(std::pow(1.0 - cosine, 5), 1.0, 0.04) * cosine * cosine;
        return std::max(1.0 - facets - coat - layers.sheen * sheen_albedo(cosine), 0.0);
    });
    const float scale = 1.0f / std::sqrt(std::max(mean_transmission(curve), 1e-3f));
    for (float& value : curve) {
        value *= scale;
    }
    return curve;
}

float mean_transmission(std::span<const float> curve) {
    float sum = 0.0f;
    for (int i = 0; i + 1 < NEARLIGHT_CURVE_SIZE; ++i) {
        const auto at = static_cast<float>(i);
        sum += curve[i] * (3.0f * at + 1.0f) + curve[i + 1] * (3.0f * at + 2.0f);
    }
    return sum / 3.0f / static_cast<float>((NEARLIGHT_CURVE_SIZE - 1) * (NEARLIGHT_CURVE_SIZE - 1));
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
    const Microfacets microfacets(alpha, beckmann, resolution(1.0 / eta));
    double sum = 0.0;
    for (std::size_t i = 0; i < kTableSize; ++i) {
        const double cosine = std::max(table_cosine(i), kMinCosine);
        sum += cosine * microfacets.mean(cosine, [&](const Direction& view, const Direction& m) {
            return reflected(microfacets, 1.0 / eta, view, m);
        });
    }
    return 2.0 * sum / kTableSize;
}

}  // namespace nearlight::core
