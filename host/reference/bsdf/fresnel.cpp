// SPDX-License-Identifier: Apache-2.0
#include "host/reference/bsdf/fresnel.h"

#include <complex>

namespace nearlight::core {
namespace {

/// Mean of the squared amplitudes of both polarisations; eta may be complex.
template <typename Index>
double unpolarised(double cosine, Index eta, Index cosine_behind) {
    const Index s = (cosine - eta * cosine_behind) / (cosine + eta * cosine_behind);
    const Index p = (eta * cosine - cosine_behind) / (eta * cosine + cosine_behind);
    return 0.5 * (std::norm(s) + std::norm(p));
}

double conductor_channel_reflectance(double cosine, double eta, double k) {
    using Complex = std::complex<double>;
    const Complex index(eta, k);
    if (std::norm(index) == 0.0) {
        return 1.0;
    }
    const Complex sine_behind2 = (1.0 - cosine * cosine) / (index * index);
    return unpolarised(cosine, index, std::sqrt(1.0 - sine_behind2));
}

}  // namespace

double fresnel_of_dielectric(double cosine, double eta) {
    if (eta == 1.0) {
        return 0.0;
    }
    const double c = std::min(cosine, 1.0);
    const double sine_behind2 = (1.0 - c * c) / (eta * eta);
    if (sine_behind2 >= 1.0 || c <= 0.0) {
        return 1.0;
    }
    return unpolarised(c, eta, std::sqrt(1.0 - sine_behind2));
}

Vec3d fresnel_of_conductor(double cosine, Vec3d eta, Vec3d k) {
    const double c = std::clamp(cosine, 0.0, 1.0);
    return {conductor_channel_reflectance(c, eta.x, k.x), conductor_channel_reflectance(c, eta.y, k.y),
            conductor_channel_reflectance(c, eta.z, k.z)};
}

Vec3d refracted(Vec3d w, Vec3d m, double eta) {
    const double cosine = dot(w, m);
    const double cosine_behind2 = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    if (cosine_behind2 <= 0.0) {
        return {};
    }
    return normalize(m * (cosine / eta - std::sqrt(cosine_behind2)) - w / eta);
}

double schlick_weight(double cosine) {
    return std::pow(std::clamp(1.0 - cosine, 0.0, 1.0), 5);
}

Vec3d schlick_reflectance(Vec3d r0, double cosine, double eta) {
    const double behind2 = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    const double weight = schlick_weight(eta > 1.0 ? cosine : std::sqrt(std::max(0.0, behind2)));
    return mix(r0, {1, 1, 1}, weight);
}

}  // namespace nearlight::core
