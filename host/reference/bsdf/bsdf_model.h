// SPDX-License-Identifier: Apache-2.0
// The models of surfaces in double precision: the reference of the kernels' (kernels/lib/bsdf), with the same
// division of a BSDF into D, its Lambertian part, and S, all else. They share no code.
#pragma once

#include <span>

#include "host/reference/bsdf/bsdf_frame.h"
#include "host/reference/bsdf/microfacets.h"

namespace nearlight::core {

/// A model at one point, with all its textures looked up. Members are those of Material, unless something
/// else is said.
struct BsdfParameters {
    uint model = NEARLIGHT_BSDF_DIFFUSE;  ///< none of those that stand for others
    bool beckmann = false;
    bool thin = false;
    bool layered = false;             ///< principled: NEARLIGHT_MATERIAL_LAYERED
    bool front = true;                ///< the viewer is on the front (outer) side
    Vec3d diffuse;                    ///< D = diffuse/π · T(cosθo) · T(cosθi), see base_transmittance()
    Vec3d base;                       ///< principled: colour of the base
    Vec3d specular{1, 1, 1};          ///< tint of what S reflects
    Vec3d transmission{1, 1, 1};      ///< tint of what S lets through; principled: x is diffuse transmission
    double alpha_x = 0, alpha_y = 0;  ///< principled: alpha_x is the roughness
    /// Conductor: real index; otherwise x is the index beyond ÷ on the viewer's side, but for panes, thin
    /// sheets and clear glass that of the material ÷ outside.
    Vec3d eta{1, 1, 1};
    Vec3d k;  ///< conductor: imaginary index
    double metallic = 0, anisotropic = 0, spec_trans = 0, spec_tint = 0, sheen = 0, sheen_tint = 0,
           flatness = 0, clearcoat = 0, clearcoat_gloss = 0;
    std::span<const float> curve;  ///< rough plastic, layered: T at equidistant cosines from 0 to 1
};

/// Uniform random numbers in [0, 1) for the choice of a lobe and of a direction in it.
struct BsdfRandom {
    double choice = 0, x = 0, y = 0;
};

/// A direction drawn from a BSDF.
struct BsdfDraw {
    Vec3d wi{0, 0, 1};
    Vec3d weight;              ///< BSDF · |cosθi| ÷ density; 0: nothing could be drawn
    double pdf = 0;            ///< density per steradian; 0 where the direction is a delta one
    double eta = 1;            ///< index on wi's side ÷ index on wo's
    bool is_delta = false;     ///< a mirror image, a refraction, or straight on
    bool is_straight = false;  ///< light passes straight on, as shadow rays do
};

/// S of one model. Directions are unit vectors in the local frame, away from the surface; wo.z > 0 is the
/// viewer's side. What goes through is given for the transport of flux: radiance has it divided by eta².
struct SpecularModel {
    /// S(wo, wi) · |cosθi|; 0 for delta directions.
    Vec3d (*eval)(const BsdfParameters&, Vec3d wo, Vec3d wi);
    /// Density of `sample`, per steradian; 0 for delta directions.
    double (*pdf)(const BsdfParameters&, Vec3d wo, Vec3d wi);
    BsdfDraw (*sample)(const BsdfParameters&, Vec3d wo, BsdfRandom random);
    /// About ∫ S |cosθi| dωi. It only steers sampling, and is 0 only where S is.
    Vec3d (*estimate)(const BsdfParameters&, Vec3d wo);
};

extern const SpecularModel kPlasticModel;
extern const SpecularModel kConductorModel;
extern const SpecularModel kDielectricModel;
extern const SpecularModel kThinDielectricModel;
extern const SpecularModel kPrincipledModel;
extern const SpecularModel kPrincipledThinModel;
extern const SpecularModel kNullModel;
extern const SpecularModel kPhongModel;
extern const SpecularModel kWardModel;

/// S of a model, or null for a model that is D alone.
const SpecularModel* specular_model(const BsdfParameters& parameters);

/// T of the comment at BsdfParameters: how much of the light of one direction reaches the base.
double base_transmittance(const BsdfParameters& parameters, double cosine);
/// D(wo, wi) · cosθi.
Vec3d eval_diffuse(const BsdfParameters& parameters, Vec3d wo, Vec3d wi);

/// Whether microfacets of this roughness count as a smooth surface.
bool is_smooth(const BsdfParameters& parameters);
Microfacets microfacets(const BsdfParameters& parameters);
/// The unit vector halfway between two directions on the same side.
inline Vec3d half_vector(Vec3d wo, Vec3d wi) {
    return normalize(wo + wi);
}
/// D(m)·G/(4·cosθo) of microfacets that reflect wi to wo; with Fresnel's factor it is S·|cosθi|.
double microfacet_reflection(const Microfacets& facets, Vec3d wo, Vec3d wi);
/// Density of the mirror image of wo in a visible normal.
double microfacet_reflection_pdf(const Microfacets& facets, Vec3d wo, Vec3d wi);

/// Unit vector about +z with density cosθ/π.
Vec3d sample_cosine(double u, double v);
/// Density of sample_cosine().
double cosine_pdf(Vec3d w);

}  // namespace nearlight::core
