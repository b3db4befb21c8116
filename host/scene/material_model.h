// SPDX-License-Identifier: Apache-2.0
// Converts the parameters of physical materials to the numbers in Material.
#pragma once

#include "kernels/shared/types.h"

namespace nearlight::core {

/// The unpolarised Fresnel reflectance of a dielectric, where eta = index behind ÷ index in front.
double dielectric_reflectance(double cosine, double eta);
/// The unpolarised Fresnel reflectance of a conductor with complex index eta + i·k.
double conductor_reflectance(double cosine, double eta, double k);
/// The mean of dielectric_reflectance() over directions, weighted by cosine: 2 ∫ F(μ) μ dμ.
double mean_dielectric_reflectance(double eta);
/// The mean of conductor_reflectance() over directions, weighted by cosine.
double mean_conductor_reflectance(double eta, double k);

/// A one-sided Lambertian material without emission and texture; `reflectance` is in [0, 1].
Material diffuse_material(Vec3 reflectance);
/// A Lambertian base under a dielectric coat; `nonlinear` saturates colours by inter-reflection below the
/// coat.
Material coat_material(Vec3 reflectance, Vec3 specular, double eta, float roughness, bool nonlinear);
/// A conductor with complex index eta + i·k, whose reflectance `specular` scales.
Material conductor_material(Vec3 eta, Vec3 k, Vec3 specular, float roughness);
/// A pane of glass if `thin` is true, otherwise the surface of a glass body.
Material glass_material(double eta, bool thin);

}  // namespace nearlight::core
