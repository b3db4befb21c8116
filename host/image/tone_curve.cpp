// SPDX-License-Identifier: Apache-2.0
#include "host/image/tone_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/names.h"

namespace nearlight::core {
namespace {

/// https://github.com/KhronosGroup/ToneMapping/tree/main/PBR_Neutral describes the formula.
Vec3 neutral(Vec3 color) {
    constexpr float kFresnel = 0.04f;  // what a dielectric adds head-on
    constexpr float kStart = 0.8f - kFresnel;
    constexpr float kDesaturation = 0.15f;
    const float least = std::min(color.x, std::min(color.y, color.z));
    const float offset = least < 2 * kFresnel ? least - least * least / (4 * kFresnel) : kFresnel;
    color = color - Vec3{offset, offset, offset};
    const float peak = max_component(color);
    if (peak < kStart) {
        return color;
    }
    const float room = 1 - kStart;
    const float limited = 1 - room * room / (peak + room - kStart);
    const float white = 1 - 1 / (kDesaturation * (peak - limited) + 1);
    return color * (limited / peak * (1 - white)) + Vec3{1, 1, 1} * (limited * white);
}

float filmic(float x) {
    x *= 0.6f;
    return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
}

/// AgX's curve of contrast, of a place in its range of 16.5 stops: a straight line through middle grey that
/// bends to 0 and 1.
double agx_contrast(double place) {
    constexpr double kPivot = 10.0 / 16.5;
    constexpr double kGrey = 0.48943708957387834;  // 0.18 to the power of 1/2.4
    constexpr double kSlope = 2.4;
    constexpr double kPower = 1.5;
    const bool is_toe = place < kPivot;
    const double run = is_toe ? kPivot : 1 - kPivot;
    const double rise = is_toe ? kGrey : 1 - kGrey;
    // The bend ends at (run, rise) if it is scaled so.
    const double scale =
        std::pow(std::pow(kSlope * run, -kPower) * (std::pow(kSlope * run / rise, kPower) - 1), -1 / kPower);
    const double t = kSlope * std::abs(place - kPivot) / scale;
    const double bent = scale * t / std::pow(1 + std::pow(t, kPower), 1 / kPower);
    return is_toe ? kGrey - bent : kGrey + bent;
}

Vec3 times(const std::array<std::array<double, 3>, 3>& m, Vec3 c) {
    const auto row = [&](const std::array<double, 3>& r) {
        return static_cast<float>(r[0] * c.x + r[1] * c.y + r[2] * c.z);
    };
    return {row(m[0]), row(m[1]), row(m[2])};
}

/// AgX [Sobotka, https://github.com/sobotka/AgX], whose inset for sRGB this is. The curve and the way back by
/// the inverse of the inset are those of its later version, on which Blender's builds
/// [https://github.com/EaryChow/AgX].
Vec3 agx(Vec3 color) {
    constexpr std::array<std::array<double, 3>, 3> kInset{
        {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
         {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
         {0.0423756549057051, 0.0784336, 0.879142973793104}}};
    constexpr std::array<std::array<double, 3>, 3> kOutset{
        {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
         {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
         {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}}};
    constexpr double kBlack = -12.47393;  // stops below 1
    constexpr double kRange = 16.5;
    const auto bend = [](float x) {
        const double stops = std::log2(std::max(static_cast<double>(x), 1e-10));
        return static_cast<float>(agx_contrast(std::clamp((stops - kBlack) / kRange, 0.0, 1.0)));
    };
    const Vec3 inset = times(kInset, color);
    const Vec3 shown = times(kOutset, {bend(inset.x), bend(inset.y), bend(inset.z)});
    const auto decode = [](float x) { return std::pow(std::clamp(x, 0.0f, 1.0f), 2.4f); };
    return {decode(shown.x), decode(shown.y), decode(shown.z)};
}

Vec3 clamped(Vec3 color) {
    return min(max(color, {0, 0, 0}), {1, 1, 1});
}

}  // namespace

std::string to_string(ToneCurve curve) {
    return name_in(kToneCurves, curve);
}

Vec3 apply_tone_curve(ToneCurve curve, Vec3 color) {
    if (curve == ToneCurve::linear) {
        return color;
    }
    const auto tame = [](float x) { return x > 0.0f ? std::min(x, 1e9f) : 0.0f; };
    color = {tame(color.x), tame(color.y), tame(color.z)};
    switch (curve) {
        case ToneCurve::neutral:
            return clamped(neutral(color));
        case ToneCurve::agx:
            return clamped(agx(color));
        default:
            return clamped({filmic(color.x), filmic(color.y), filmic(color.z)});
    }
}

}  // namespace nearlight::core
