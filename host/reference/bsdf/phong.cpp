// SPDX-License-Identifier: Apache-2.0
// The lobe of the modified Phong model about the mirror direction [Lafortune and Willems 1994].
#include <numbers>

#include "host/reference/bsdf/bsdf_model.h"

namespace nearlight::core {
namespace {

/// The power of the cosine that a lobe of this roughness has.
double exponent_of(const BsdfParameters& p) {
    const double alpha = std::max(p.alpha_x, static_cast<double>(NEARLIGHT_MIN_ALPHA));
    return 2 / (alpha * alpha) - 2;
}

/// A power of the cosine to the mirror direction, divided by 2π.
double phong_lobe(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    const double cosine = dot(wi, Vec3d{-wo.x, -wo.y, wo.z});
    return wo.z > 0 && wi.z > 0 && cosine > 0 ? std::pow(cosine, exponent_of(p)) / (2 * std::numbers::pi) : 0;
}

Vec3d eval_phong(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    return p.specular * ((exponent_of(p) + 2) * phong_lobe(p, wo, wi) * wi.z);
}

double pdf_phong(const BsdfParameters& p, Vec3d wo, Vec3d wi) {
    return (exponent_of(p) + 1) * phong_lobe(p, wo, wi);
}

BsdfDraw sample_phong(const BsdfParameters& p, Vec3d wo, BsdfRandom random) {
    if (wo.z <= 0) {
        return {};
    }
    const double cosine = std::pow(random.x, 1 / (exponent_of(p) + 1));
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double angle = 2 * std::numbers::pi * random.y;
    const Vec3d axis{-wo.x, -wo.y, wo.z};
    const Vec3d across =
        normalize(std::abs(axis.x) < 0.5 ? cross(axis, Vec3d{1, 0, 0}) : cross(axis, Vec3d{0, 1, 0}));
    const Vec3d wi =
        axis * cosine + across * (sine * std::cos(angle)) + cross(axis, across) * (sine * std::sin(angle));
    const double pdf = pdf_phong(p, wo, wi);
    return pdf > 0 ? BsdfDraw{.wi = wi, .weight = eval_phong(p, wo, wi) / pdf, .pdf = pdf} : BsdfDraw{};
}

Vec3d estimate_phong(const BsdfParameters& p, Vec3d wo) {
    return p.specular * std::max(0.02, wo.z);
}

}  // namespace

const SpecularModel kPhongModel{eval_phong, pdf_phong, sample_phong, estimate_phong};

}  // namespace nearlight::core
