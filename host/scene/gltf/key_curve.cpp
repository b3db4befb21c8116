// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/key_curve.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nearlight::core::gltf {
namespace {

CurveShape shape_named(const GltfFile& file, const std::string& name, const std::string& owner) {
    if (name == "LINEAR") {
        return CurveShape::linear;
    }
    if (name == "STEP") {
        return CurveShape::step;
    }
    if (name != "CUBICSPLINE") {
        file.fail(owner + " has the unknown interpolation '" + name + "'");
    }
    return CurveShape::cubic;
}

/// The numbers of an accessor that an animation refers to.
std::vector<float> finite_numbers(const GltfFile& file, int accessor, int components, const char* what,
                                  const std::string& owner) {
    const tinygltf::Accessor& found = file.at(file.model.accessors, accessor, "accessor", owner);
    if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(found.type)) != components) {
        file.fail(owner + " has " + what + " that are not " + std::to_string(components) +
                  (components == 1 ? " number each" : " numbers each"));
    }
    std::vector<float> numbers = read_numbers(file, accessor, components);
    if (!std::ranges::all_of(numbers, [](float number) { return std::isfinite(number); })) {
        file.fail(owner + " has " + what + " that are not finite");
    }
    return numbers;
}

/// Value `part` of key `key`: of cubic curves 0 and 2 are the tangents before and after it, and 1 its value.
std::vector<double> key_value(const KeyCurve& curve, std::size_t key, std::size_t part = 1) {
    const std::size_t first = (curve.shape == CurveShape::cubic ? 3 * key + part : key) * curve.width;
    const auto from = curve.values.begin() + static_cast<std::ptrdiff_t>(first);
    return {from, from + static_cast<std::ptrdiff_t>(curve.width)};
}

/// a·x + b·y
std::vector<double> blend(double a, std::vector<double> x, double b, const std::vector<double>& y) {
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = a * x[i] + b * y[i];
    }
    return x;
}

std::vector<double> unit(std::vector<double> quaternion) {
    const double length =
        std::sqrt(std::inner_product(quaternion.begin(), quaternion.end(), quaternion.begin(), 0.0));
    return length > 0 ? blend(1 / length, quaternion, 0, quaternion) : quaternion;
}

/// Turns evenly from x to y on the shorter way.
std::vector<double> slerp(std::vector<double> x, std::vector<double> y, double t) {
    x = unit(std::move(x));
    y = unit(std::move(y));
    double cosine = std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
    const double sign = cosine < 0 ? -1 : 1;
    cosine *= sign;
    const double angle = std::acos(std::min(cosine, 1.0));
    if (angle < 1e-6) {  // the sine below would be too near to 0
        return unit(blend(1 - t, std::move(x), sign * t, y));
    }
    return blend(std::sin((1 - t) * angle) / std::sin(angle), std::move(x),
                 sign * std::sin(t * angle) / std::sin(angle), y);
}

/// The cubic Hermite spline of glTF 2.0, appendix C.5, where tangents are per second.
std::vector<double> spline(const KeyCurve& curve, std::size_t key, double t, double seconds) {
    const double t2 = t * t;
    const double t3 = t2 * t;
    return blend(
        1,
        blend(2 * t3 - 3 * t2 + 1, key_value(curve, key), seconds * (t3 - 2 * t2 + t),
              key_value(curve, key, 2)),
        1,
        blend(3 * t2 - 2 * t3, key_value(curve, key + 1), seconds * (t3 - t2), key_value(curve, key + 1, 0)));
}

}  // namespace

KeyCurve read_curve(const GltfFile& file, const tinygltf::AnimationSampler& sampler, CurveKind kind,
                    std::size_t width, int components, const std::string& owner) {
    KeyCurve curve{.shape = shape_named(file, sampler.interpolation, owner),
                   .kind = kind,
                   .width = width,
                   .times = finite_numbers(file, sampler.input, 1, "times", owner),
                   .values = finite_numbers(file, sampler.output, components, "values", owner)};
    if (curve.times.empty()) {
        file.fail(owner + " has a sampler without keys");
    }
    if (!std::ranges::is_sorted(curve.times)) {
        file.fail(owner + " has times that do not ascend");
    }
    const std::size_t wanted = curve.times.size() * (curve.shape == CurveShape::cubic ? 3 : 1) * width;
    if (curve.values.size() != wanted) {
        file.fail(owner + " has " + std::to_string(curve.values.size()) + " numbers for its " +
                  std::to_string(curve.times.size()) + " keys, which need " + std::to_string(wanted));
    }
    return curve;
}

std::vector<double> value_at(const KeyCurve& curve, double seconds) {
    const auto after = std::ranges::upper_bound(curve.times, static_cast<float>(seconds));
    std::vector<double> value;
    if (after == curve.times.begin() || after == curve.times.end() || curve.shape == CurveShape::step) {
        value = key_value(curve, after == curve.times.begin()
                                     ? 0
                                     : static_cast<std::size_t>(after - curve.times.begin()) - 1);
    } else {
        const auto key = static_cast<std::size_t>(after - curve.times.begin()) - 1;
        const double step = double{curve.times[key + 1]} - double{curve.times[key]};
        const double t = std::clamp((seconds - double{curve.times[key]}) / step, 0.0, 1.0);
        if (curve.shape == CurveShape::cubic) {
            value = spline(curve, key, t, step);
        } else if (curve.kind == CurveKind::rotation) {
            value = slerp(key_value(curve, key), key_value(curve, key + 1), t);
        } else {
            value = blend(1 - t, key_value(curve, key), t, key_value(curve, key + 1));
        }
    }
    return curve.kind == CurveKind::rotation ? unit(std::move(value)) : value;
}

}  // namespace nearlight::core::gltf
