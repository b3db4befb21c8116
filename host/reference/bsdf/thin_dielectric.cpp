// SPDX-License-Identifier: Apache-2.0
// A pane of glass with both its faces, between which light bounces any number of times; or one face of clear
// glass. Both let light pass straight on.
#include "host/reference/bsdf/bsdf_model.h"
#include "host/reference/bsdf/fresnel.h"

namespace nearlight::core {
namespace {

/// R + T²R + T²R³ + … for a face that reflects R and lets T = 1 − R through, which sums up to 2R/(1 + R); of
/// clear glass, R.
double pane_reflectance(const BsdfParameters& p, double cosine) {
    const double face = fresnel_of_dielectric(cosine, p.eta.x);
    return p.model == NEARLIGHT_BSDF_CLEAR_GLASS ? face : 2 * face / (1 + face);
}

Vec3d eval_pane(const BsdfParameters&, Vec3d, Vec3d) {
    return {};
}

double pdf_pane(const BsdfParameters&, Vec3d, Vec3d) {
    return 0;
}

BsdfDraw sample_pane(const BsdfParameters& p, Vec3d wo, BsdfRandom random) {
    if (wo.z <= 0) {
        return {};
    }
    if (random.choice < pane_reflectance(p, wo.z)) {
        return {.wi = {-wo.x, -wo.y, wo.z}, .weight = p.specular, .is_delta = true};
    }
    return {.wi = -wo, .weight = p.transmission, .is_delta = true, .is_straight = true};
}

Vec3d estimate_pane(const BsdfParameters& p, Vec3d wo) {
    return mix(p.transmission, p.specular, pane_reflectance(p, wo.z));
}

}  // namespace

const SpecularModel kThinDielectricModel{eval_pane, pdf_pane, sample_pane, estimate_pane};

}  // namespace nearlight::core
