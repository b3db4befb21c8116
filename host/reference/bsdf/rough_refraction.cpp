// SPDX-License-Identifier: Apache-2.0
#include "host/reference/bsdf/rough_refraction.h"

namespace nearlight::core {
namespace {

/// Steradians of m for one of wi [Walter et al. 2007, equation 17].
double refraction_jacobian(Vec3d wo, Vec3d wi, Vec3d m, double eta) {
    const double sum = dot(wo, m) + eta * dot(wi, m);
    return eta * eta * std::abs(dot(wi, m)) / (sum * sum);
}

/// Whether the microfacet shows its upper side to wo and its lower side to wi.
bool lies_between(Vec3d wo, Vec3d wi, Vec3d m) {
    return dot(wo, m) > 0 && dot(wi, m) < 0;
}

}  // namespace

Vec3d refraction_normal(Vec3d wo, Vec3d wi, double eta) {
    const Vec3d m = normalize(wo + wi * eta);
    return m.z < 0 ? -m : m;
}

double microfacet_refraction(const Microfacets& facets, Vec3d wo, Vec3d wi, double eta) {
    const Vec3d m = refraction_normal(wo, wi, eta);
    if (!lies_between(wo, wi, m)) {
        return 0;
    }
    return facets.density(m) * facets.masking(wo, wi, m) * dot(wo, m) / wo.z *
           refraction_jacobian(wo, wi, m, eta);
}

double microfacet_refraction_pdf(const Microfacets& facets, Vec3d wo, Vec3d wi, double eta) {
    const Vec3d m = refraction_normal(wo, wi, eta);
    return lies_between(wo, wi, m) ? facets.visible_density(wo, m) * refraction_jacobian(wo, wi, m, eta) : 0;
}

}  // namespace nearlight::core
