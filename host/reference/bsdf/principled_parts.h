// SPDX-License-Identifier: Apache-2.0
// What the two principled models have in common [Burley, Physically-Based Shading at Disney, SIGGRAPH course
// 2012; Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering, SIGGRAPH course 2015],
// with the normalisations of Mitsuba 3.
#pragma once

#include "host/reference/bsdf/bsdf_model.h"

namespace nearlight::core {

/// GGX microfacets of a roughness, stretched by `anisotropic`.
Microfacets principled_facets(double roughness, double anisotropic);
/// The base's hue, of luminance 1.
Vec3d principled_tint(Vec3d base);
/// The base without its Lambertian part and without sheen, × π / base: retro-reflection, and the share of the
/// flat look of subsurface scattering.
double principled_retro(const BsdfParameters& p, Vec3d wo, Vec3d wi);
/// Reflection at grazing angles, as of fabric.
Vec3d principled_sheen(const BsdfParameters& p, Vec3d wo, Vec3d wi);

/// Clearcoat's distribution GTR1 [Burley 2012, appendix B], and its α for a gloss from 0 to 1.
double clearcoat_alpha(double gloss);
double clearcoat_density(Vec3d m, double alpha);
/// A normal with the density D·cosθ.
Vec3d sample_clearcoat_normal(double alpha, double u, double v);

}  // namespace nearlight::core
