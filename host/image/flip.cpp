// SPDX-License-Identifier: Apache-2.0
// Sections and equations are those of [Andersson et al. 2020].
#include "host/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "host/base/math.h"

namespace nearlight::core {
namespace {

/// One component of a picture.
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<float> values;

    Plane(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    [[nodiscard]] const float* row(int y) const {
        return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    }
    [[nodiscard]] float* row(int y) { return const_cast<float*>(std::as_const(*this).row(y)); }
};

/// The weights of a filter at −radius … radius.
using Kernel = std::vector<float>;

// ---- Colour spaces. XYZ is relative to the white of sRGB (D65), so that white is (1, 1, 1). ----

constexpr Vec3 kWhite{0.950470f, 1.0f, 1.088830f};

Vec3 rgb_to_xyz(Vec3 c) {
    return Vec3{0.4124564f * c.x + 0.3575761f * c.y + 0.1804375f * c.z,
                0.2126729f * c.x + 0.7151522f * c.y + 0.0721750f * c.z,
                0.0193339f * c.x + 0.1191920f * c.y + 0.9503041f * c.z} *
           Vec3{1.0f / kWhite.x, 1.0f / kWhite.y, 1.0f / kWhite.z};
}

Vec3 xyz_to_rgb(Vec3 relative) {
    const Vec3 c = relative * kWhite;
    return {3.2404542f * c.x - 1.5371385f * c.y - 0.4985314f * c.z,
            -0.9692660f * c.x + 1.8760108f * c.y + 0.0415560f * c.z,
            0.0556434f * c.x - 0.2040259f * c.y + 1.0572252f * c.z};
}

/// L*a*b* without its cube root, in which filtering is linear.
Vec3 xyz_to_ycxcz(Vec3 c) {
    return {116.0f * c.y - 16.0f, 500.0f * (c.x - c.y), 200.0f * (c.y - c.z)};
}

Vec3 ycxcz_to_xyz(Vec3 c) {
    const float y = (c.x + 16.0f) / 116.0f;
    return {y + c.y / 500.0f, y, y - c.z / 200.0f};
}

float lab_curve(float t) {
    constexpr float kDelta = 6.0f / 29.0f;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
}

/// L*a*b* with the Hunt effect: colours look less saturated where it is dark (section 4.1.2).
Vec3 rgb_to_hunt_lab(Vec3 rgb) {
    const Vec3 xyz = rgb_to_xyz(rgb);
    const Vec3 lab = xyz_to_ycxcz({lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z)});
    return {lab.x, 0.01f * lab.x * lab.y, 0.01f * lab.x * lab.z};
}

/// The distance of two colours, made for large differences (section 4.1.3).
float hyab(Vec3 a, Vec3 b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// ---- Filters ----

/// Filters along rows, then along columns. The picture's border is repeated outwards.
Plane convolve(const Plane& input, const Kernel& along_x, const Kernel& along_y) {
    const int radius_x = static_cast<int>(along_x.size() / 2);
    const int radius_y = static_cast<int>(along_y.size() / 2);
    Plane rows(input.width, input.height);
    std::vector<float> padded(static_cast<std::size_t>(input.width) + along_x.size() - 1);
    for (int y = 0; y < input.height; ++y) {
        for (int i = 0; i < static_cast<int>(padded.size()); ++i) {
            padded[static_cast<std::size_t>(i)] = input.row(y)[std::clamp(i - radius_x, 0, input.width - 1)];
        }
        float* const output = rows.row(y);
        for (std::size_t k = 0; k < along_x.size(); ++k) {
            for (int x = 0; x < input.width; ++x) {
                output[x] += along_x[k] * padded[static_cast<std::size_t>(x) + k];
            }
        }
    }
    Plane result(input.width, input.height);
    for (int y = 0; y < input.height; ++y) {
        float* const output = result.row(y);
        for (std::size_t k = 0; k < along_y.size(); ++k) {
            const float* const source =
                rows.row(std::clamp(y + static_cast<int>(k) - radius_y, 0, input.height - 1));
            for (int x = 0; x < input.width; ++x) {
                output[x] += along_y[k] * source[x];
            }
        }
    }
    return result;
}

/// A term a·√(π/b)·exp(−π²x²/b) of a contrast sensitivity filter, x in degrees (section 4.1.1, table 1).
struct Gaussian {
    float a, b;
};

/// The sum of Gaussians over the plane is separable term by term; the weights of all terms sum to 1.
Plane filter_contrast(const Plane& input, std::span<const Gaussian> terms, float pixels_per_degree) {
    // The radius of every filter is three standard deviations of the widest Gaussian of all channels.
    constexpr float kWidest = 0.04f;
    const int radius =
        static_cast<int>(std::ceil(3.0f * std::sqrt(kWidest / (2.0f * kPi * kPi)) * pixels_per_degree));
    std::vector<Kernel> kernels;
    std::vector<float> weights;
    float total = 0.0f;
    for (const Gaussian& term : terms) {
        Kernel kernel;
        float sum = 0.0f;
        for (int i = -radius; i <= radius; ++i) {
            const float x = static_cast<float>(i) / pixels_per_degree;
            kernel.push_back(std::exp(-kPi * kPi * x * x / term.b));
            sum += kernel.back();
        }
        for (float& weight : kernel) {
            weight /= sum;
        }
        kernels.push_back(std::move(kernel));
        weights.push_back(term.a * std::sqrt(kPi / term.b) * sum * sum);
        total += weights.back();
    }
    Plane result(input.width, input.height);
    for (std::size_t t = 0; t < kernels.size(); ++t) {
        const Plane part = convolve(input, kernels[t], kernels[t]);
        for (std::size_t i = 0; i < result.values.size(); ++i) {
            result.values[i] += weights[t] / total * part.values[i];
        }
    }
    return result;
}

/// The Gaussian of the feature detectors and its derivatives (section 4.2, eq. 9 to 11). In the derivatives,
/// positive weights sum to 1 and negative ones to −1.
struct FeatureKernels {
    Kernel smooth;  ///< sums to 1
    Kernel edge;    ///< first derivative
    Kernel point;   ///< second derivative
};

void normalize_signs(Kernel& kernel) {
    float positive = 0.0f;
    float negative = 0.0f;
    for (const float weight : kernel) {
        (weight > 0.0f ? positive : negative) += std::abs(weight);
    }
    for (float& weight : kernel) {
        weight /= weight > 0.0f ? positive : negative;
    }
}

FeatureKernels feature_kernels(float pixels_per_degree) {
    constexpr float kFeatureDegrees = 0.082f;
    const float deviation = 0.5f * kFeatureDegrees * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0f * deviation));
    FeatureKernels kernels;
    float sum = 0.0f;
    for (int i = -radius; i <= radius; ++i) {
        const auto x = static_cast<float>(i);
        const float gaussian = std::exp(-x * x / (2.0f * deviation * deviation));
        kernels.smooth.push_back(gaussian);
        kernels.edge.push_back(-x * gaussian);
        kernels.point.push_back((x * x / (deviation * deviation) - 1.0f) * gaussian);
        sum += gaussian;
    }
    for (float& weight : kernels.smooth) {
        weight /= sum;
    }
    normalize_signs(kernels.edge);
    normalize_signs(kernels.point);
    return kernels;
}

/// The strength of a feature in each pixel, whatever its direction.
Plane feature_strength(const Plane& luminance, const Kernel& derivative, const Kernel& smooth) {
    Plane strength = convolve(luminance, derivative, smooth);
    const Plane vertical = convolve(luminance, smooth, derivative);
    for (std::size_t i = 0; i < strength.values.size(); ++i) {
        strength.values[i] = std::hypot(strength.values[i], vertical.values[i]);
    }
    return strength;
}

// ---- The two pipelines ----

std::array<Plane, 3> to_ycxcz(int width, int height, std::span<const Vec3> pixels) {
    std::array<Plane, 3> planes{Plane(width, height), Plane(width, height), Plane(width, height)};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Vec3 c = xyz_to_ycxcz(rgb_to_xyz(min(max(pixels[i], Vec3{0, 0, 0}), Vec3{1, 1, 1})));
        planes[0].values[i] = c.x;
        planes[1].values[i] = c.y;
        planes[2].values[i] = c.z;
    }
    return planes;
}

/// The colours that remain at the viewing distance, in Hunt-adjusted L*a*b*.
std::vector<Vec3> perceived_colors(const std::array<Plane, 3>& ycxcz, float pixels_per_degree) {
    constexpr std::array<Gaussian, 1> kAchromatic{{{1.0f, 0.0047f}}};
    constexpr std::array<Gaussian, 1> kRedGreen{{{1.0f, 0.0053f}}};
    constexpr std::array<Gaussian, 2> kBlueYellow{{{34.1f, 0.04f}, {13.5f, 0.025f}}};
    const Plane y = filter_contrast(ycxcz[0], kAchromatic, pixels_per_degree);
    const Plane cx = filter_contrast(ycxcz[1], kRedGreen, pixels_per_degree);
    const Plane cz = filter_contrast(ycxcz[2], kBlueYellow, pixels_per_degree);
    std::vector<Vec3> colors(y.values.size());
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const Vec3 rgb = xyz_to_rgb(ycxcz_to_xyz({y.values[i], cx.values[i], cz.values[i]}));
        colors[i] = rgb_to_hunt_lab(min(max(rgb, Vec3{0, 0, 0}), Vec3{1, 1, 1}));
    }
    return colors;
}

/// Compresses large differences. The maximum, that of green and blue, becomes 1 (section 4.1.4, eq. 8).
float remap_color_error(float error, float max_error) {
    constexpr float kKneeError = 0.4f;
    constexpr float kKneeValue = 0.95f;
    const float knee = kKneeError * max_error;
    return error < knee ? kKneeValue / knee * error
                        : kKneeValue + (error - knee) / (max_error - knee) * (1.0f - kKneeValue);
}

constexpr float kColorExponent = 0.7f;

std::vector<float> color_error(const std::array<Plane, 3>& a, const std::array<Plane, 3>& b,
                               float pixels_per_degree) {
    const float max_error =
        std::pow(hyab(rgb_to_hunt_lab({0, 1, 0}), rgb_to_hunt_lab({0, 0, 1})), kColorExponent);
    const std::vector<Vec3> colors_a = perceived_colors(a, pixels_per_degree);
    const std::vector<Vec3> colors_b = perceived_colors(b, pixels_per_degree);
    std::vector<float> error(colors_a.size());
    for (std::size_t i = 0; i < error.size(); ++i) {
        error[i] = remap_color_error(std::pow(hyab(colors_a[i], colors_b[i]), kColorExponent), max_error);
    }
    return error;
}

/// How much the pictures differ in edges and points, in each pixel (section 4.2).
std::vector<float> feature_error(Plane luminance_a, Plane luminance_b, float pixels_per_degree) {
    for (Plane* plane : {&luminance_a, &luminance_b}) {
        for (float& value : plane->values) {
            value = (value + 16.0f) / 116.0f;
        }
    }
    const FeatureKernels kernels = feature_kernels(pixels_per_degree);
    std::vector<float> error(luminance_a.values.size());
    for (const Kernel* derivative : {&kernels.edge, &kernels.point}) {
        const Plane a = feature_strength(luminance_a, *derivative, kernels.smooth);
        const Plane b = feature_strength(luminance_b, *derivative, kernels.smooth);
        for (std::size_t i = 0; i < error.size(); ++i) {
            error[i] = std::max(error[i], std::abs(a.values[i] - b.values[i]));
        }
    }
    for (float& value : error) {
        value = std::sqrt(value / std::sqrt(2.0f));
    }
    return error;
}

}  // namespace

std::vector<float> flip_error(int width, int height, std::span<const Vec3> a, std::span<const Vec3> b,
                              float pixels_per_degree) {
    const std::array<Plane, 3> planes_a = to_ycxcz(width, height, a);
    const std::array<Plane, 3> planes_b = to_ycxcz(width, height, b);
    std::vector<float> error = color_error(planes_a, planes_b, pixels_per_degree);
    const std::vector<float> features = feature_error(planes_a[0], planes_b[0], pixels_per_degree);
    for (std::size_t i = 0; i < error.size(); ++i) {
        error[i] = std::pow(error[i], 1.0f - features[i]);  // eq. 14
    }
    return error;
}

}  // namespace nearlight::core
