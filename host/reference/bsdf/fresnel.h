// SPDX-License-Identifier: Apache-2.0
// Fresnel's formulas for unpolarised light, and Schlick's approximations of them.
#pragma once

#include "host/base/vec3d.h"

namespace nearlight::core {

/// The reflectance of a boundary between dielectrics for cosine ≥ 0; 1 beyond the critical angle. eta is the
/// refractive index behind the boundary ÷ that in front of it.
double fresnel_of_dielectric(double cosine, double eta);
/// The reflectance of a metal of complex refractive index eta + i·k, channel by channel.
Vec3d fresnel_of_conductor(double cosine, Vec3d eta, Vec3d k);

/// The direction into which a boundary with the normal m refracts w (both unit vectors, dot(w, m) > 0, away
/// from the surface); eta as for fresnel_of_dielectric(). The zero vector on total internal reflection.
Vec3d refracted(Vec3d w, Vec3d m, double eta);

/// The weight (1 − cosine)⁵ [Schlick, An Inexpensive BRDF Model for Physically-Based Rendering, 1994].
double schlick_weight(double cosine);
/// Schlick's reflectance with the value r0 at normal incidence. Where eta is below 1, the angle behind the
/// boundary counts.
Vec3d schlick_reflectance(Vec3d r0, double cosine, double eta);

}  // namespace nearlight::core
