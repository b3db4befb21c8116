// SPDX-License-Identifier: Apache-2.0
// Refraction by microfacets [Walter et al., Microfacet Models for Refraction through Rough Surfaces, EGSR
// 2007]. wo.z > 0 > wi.z, and eta is the index on wi's side ÷ the index on wo's.
#pragma once

#include "host/reference/bsdf/microfacets.h"

namespace nearlight::core {

/// The normal (z > 0) of the microfacets that refract between wo and wi [equation 16].
Vec3d refraction_normal(Vec3d wo, Vec3d wi, double eta);
/// Equation 21 without Fresnel's factor, times |cosθi|, for the transport of flux.
double microfacet_refraction(const Microfacets& facets, Vec3d wo, Vec3d wi, double eta);
/// Density of the refraction of wo by a visible normal, per steradian of wi.
double microfacet_refraction_pdf(const Microfacets& facets, Vec3d wo, Vec3d wi, double eta);

}  // namespace nearlight::core
