// SPDX-License-Identifier: Apache-2.0
// From the parameters of physical materials to the numbers in Material.
#pragma once

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Fresnel reflectance of a dielectric, eta = index behind ÷ index in front, unpolarised.
double dielectric_reflectance(double cosine, double eta);
/// The same of a conductor with complex index eta + i·k.
double conductor_reflectance(double cosine, double eta, double k);
/// Means over directions, weighted by cosine: 2 ∫ F(μ) μ dμ.
double mean_dielectric_reflectance(double eta);
double mean_conductor_reflectance(double eta, double k);

/// One-sided, no emission, no texture; colours in [0, 1].
Material diffuse_material(Vec3 reflectance);
/// Lambertian base under a dielectric coat; `nonlinear` saturates colours by inter-reflection below the coat.
Material coat_material(Vec3 reflectance, Vec3 specular, double eta, float roughness, bool nonlinear);
Material conductor_material(Vec3 eta, Vec3 k, Vec3 specular, float roughness);
/// A body (thin = false) or a pane of glass.
Material glass_material(double eta, bool thin);

}  // namespace nearlight::core
