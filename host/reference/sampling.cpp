// SPDX-License-Identifier: Apache-2.0
#include "host/reference/sampling.h"

namespace nearlight::core {
namespace {

float square(float x) {
    return x * x;
}

float conductor_channel(float cos_i, float eta, float k) {
    const float cos2 = square(cos_i);
    const float sin2 = 1.0f - cos2;
    const float t = eta * eta - k * k - sin2;
    const float modulus = std::sqrt(t * t + 4.0f * eta * eta * k * k);  // a² + b²
    const float a = std::sqrt(std::max(0.0f, 0.5f * (modulus + t)));
    const float s_sum = modulus + cos2;
    const float s_cross = 2.0f * a * cos_i;
    const float perpendicular = (s_sum - s_cross) / (s_sum + s_cross);
    const float p_sum = cos2 * modulus + sin2 * sin2;
    const float p_cross = s_cross * sin2;
    const float parallel = perpendicular * (p_sum - p_cross) / (p_sum + p_cross);
    return 0.5f * (perpendicular + parallel);
}

}  // namespace

Vec3 sample_cosine_hemisphere(Point2 u) {
    const float radius = std::sqrt(u.x);
    const float angle = 2.0f * kPi * u.y;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0f, 1.0f - u.x))};
}

Point2 sample_triangle(Point2 u) {
    const float root = std::sqrt(1.0f - u.x);
    return {root * (1.0f - u.y), root * u.y};
}

float fresnel_dielectric(float cos_i, float eta) {
    const float sin2_t = (1.0f - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1.0f) {
        return 1.0f;
    }
    const float cos_t = std::sqrt(1.0f - sin2_t);
    const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 0.5f * (square(perpendicular) + square(parallel));
}

Vec3 fresnel_conductor(float cos_i, Vec3 eta, Vec3 k) {
    const float c = std::clamp(cos_i, 1e-4f, 1.0f);
    return {conductor_channel(c, eta.x, k.x), conductor_channel(c, eta.y, k.y),
            conductor_channel(c, eta.z, k.z)};
}

Vec3 reflect(Vec3 w, Vec3 m) {
    return m * (2.0f * dot(w, m)) - w;
}

Vec3 refract(Vec3 w, Vec3 m, float eta) {
    const float cos_i = dot(w, m);
    const float cos2_t = 1.0f - (1.0f - cos_i * cos_i) / (eta * eta);
    if (cos2_t <= 0.0f) {
        return {0, 0, 0};
    }
    return normalize(m * (cos_i / eta - std::sqrt(cos2_t)) - w / eta);
}

Vec3 sample_ggx_visible_normal(Vec3 w, float alpha, Point2 u) {
    // On the stretched surface the visible normals are those of a hemisphere, whose projection is a half disc
    // and a squeezed half disc.
    const Vec3 view = normalize({alpha * w.x, alpha * w.y, w.z});
    const Vec3 up{0, 0, 1};
    Vec3 t1 = cross(up, view);
    t1 = length(t1) > 1e-6f ? normalize(t1) : Vec3{1, 0, 0};
    const Vec3 t2 = cross(view, t1);
    const float radius = std::sqrt(u.x);
    const float angle = 2.0f * kPi * u.y;
    const float x = radius * std::cos(angle);
    const float squeeze = 0.5f * (1.0f + view.z);
    const float y =
        (1.0f - squeeze) * std::sqrt(std::max(0.0f, 1.0f - x * x)) + squeeze * radius * std::sin(angle);
    const Vec3 normal = t1 * x + t2 * y + view * std::sqrt(std::max(0.0f, 1.0f - x * x - y * y));
    return normalize({alpha * normal.x, alpha * normal.y, std::max(1e-6f, normal.z)});
}

float ggx_masking(Vec3 w, float alpha) {
    const float cos2 = w.z * w.z;
    if (cos2 <= 0.0f) {
        return 0.0f;
    }
    const float tan2 = std::max(0.0f, 1.0f - cos2) / cos2;
    return 2.0f / (1.0f + std::sqrt(1.0f + alpha * alpha * tan2));
}

}  // namespace nearlight::core
