// SPDX-License-Identifier: Apache-2.0
// Transmission curves, which weigh the diffuse part of coated surfaces (Material::curve), and how much light
// coats reflect back into the base.
#pragma once

#include <array>
#include <span>

#include "host/scene/scene.h"

namespace nearlight::core {

/// Values at the cosines i / (NEARLIGHT_CURVE_SIZE − 1).
using TransmissionCurve = std::array<float, NEARLIGHT_CURVE_SIZE>;

/// Adds a row to Scene::transmission_curves unless an equal one is there; returns its number.
uint add_curve(Scene& scene, const TransmissionCurve& curve);

/// 1 − F(c) of a smooth dielectric; eta = interior ÷ exterior index.
TransmissionCurve smooth_coat_curve(double eta);
/// The share of light, coming in at each cosine, that microfacets let through without shadowing it, as
/// Mitsuba's `roughplastic` weighs its base, with the errors of its quadrature and of its table.
TransmissionCurve rough_coat_curve(double eta, double alpha, bool beckmann);
/// 1 − ½(1 − c)⁵ [Burley 2012].
TransmissionCurve principled_curve();

/// What lies over the base of a principled material.
struct Layers {
    double eta = 1.5;        ///< index of the facets' dielectric, at least 1
    double roughness = 0.5;  ///< of the facets, the root of α
    double clearcoat = 0;
    double sheen = 0;

    auto operator<=>(const Layers&) const = default;
};
/// What the layers do not reflect at each cosine, divided by the root of its mean. A base of albedo 1 with
/// this T on both ends reflects all that the layers leave [as Ashikhmin & Shirley, An Anisotropic Phong BRDF
/// Model, 2000, couple a base and its coat].
TransmissionCurve layered_curve(const Layers& layers);

/// 2 ∫ T(c) c dc of a curve.
float mean_transmission(std::span<const float> curve);

/// The mean reflectance of a smooth coat from inside, by the fits that Mitsuba's `plastic` uses.
double smooth_internal_reflectance(double eta);
/// The same of microfacets as Mitsuba's `roughplastic` computes it: the plain mean over its table's cosines.
double rough_internal_reflectance(double eta, double alpha, bool beckmann);

}  // namespace nearlight::core
