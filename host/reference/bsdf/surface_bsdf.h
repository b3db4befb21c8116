// SPDX-License-Identifier: Apache-2.0
// The BSDF of a surface where a ray met it, in world space.
#pragma once

#include <array>

#include "host/reference/bsdf/bsdf_model.h"
#include "host/reference/surface.h"

namespace nearlight::core {

/// What is carried from wi to wo: radiance is divided by the square of the relative index where it enters a
/// denser body, flux is not. `camera` is radiance that reaches the camera by nothing but mirrors and glass,
/// which refracts even where the scene has clear glass; there, indices change no radiance.
enum class Transport { radiance, flux, camera };

/// Both parts of a BSDF, times |cosθi|.
struct BsdfValue {
    Vec3d diffuse;   ///< D
    Vec3d specular;  ///< S

    [[nodiscard]] Vec3d sum() const { return diffuse + specular; }
};

/// A direction drawn from D or S.
struct SurfaceDraw : BsdfDraw {
    bool is_diffuse = false;  ///< drawn from D
};

/// Numbers that fill the unit cube evenly as `index` counts up, for quadrature [Roberts, The Unreasonable
/// Effectiveness of Quasirandom Sequences, 2018].
BsdfRandom even_random(int index);

/// The material at a hit, with masks, blends, sides and maps resolved. Which side of a mask or blend is taken
/// is decided by `choice`, uniform in [0, 1): expectations over it are those of the whole material. Where
/// opacity is 0 or 1 it does not matter. Directions are unit vectors away from the surface.
class SurfaceBsdf {
  public:
    SurfaceBsdf(const Scene& scene, const Surface& surface, Vec3d wo, double choice,
                Transport transport = Transport::radiance);

    [[nodiscard]] bool has_diffuse() const { return diffuse_chance_ > 0; }
    [[nodiscard]] bool has_specular() const { return specular_chance_ > 0; }
    /// The shading normal on wo's side, with maps applied.
    [[nodiscard]] Vec3d normal() const { return frame_.n; }
    /// ∫ D cosθi dωi without the light that T(cosθi) holds back: what wo sees of evenly lit matter.
    [[nodiscard]] Vec3d diffuse_reflectance() const;

    [[nodiscard]] BsdfValue eval(Vec3d wi) const;
    /// Density of sample(): the sum over D and S of the chance that it draws from that part, times the part's
    /// density.
    [[nodiscard]] double pdf(Vec3d wi) const;
    /// Draws from D with the probability diffuse_chance(), otherwise from S. The weight is that part of the
    /// BSDF divided by the density of that part, its chance included; so is `pdf`.
    [[nodiscard]] SurfaceDraw sample(double part, BsdfRandom random) const;

    /// The parts alone. Their densities do not include the chances.
    [[nodiscard]] double diffuse_chance() const { return diffuse_chance_; }
    [[nodiscard]] double specular_chance() const { return specular_chance_; }
    [[nodiscard]] double diffuse_pdf(Vec3d wi) const;
    [[nodiscard]] double specular_pdf(Vec3d wi) const;
    [[nodiscard]] SurfaceDraw sample_diffuse(BsdfRandom random) const;
    [[nodiscard]] SurfaceDraw sample_specular(BsdfRandom random) const;

    /// ∫ D |cosθi| dωi and ∫ S |cosθi| dωi for the transport of flux, by the numbers of even_random(); exact
    /// for mirrors and smooth glass, whose estimate() is (without the shadowing of maps).
    [[nodiscard]] BsdfValue albedo(int samples) const;

    /// The model that was resolved. Where a one-sided surface shows its back, it has neither D nor S.
    [[nodiscard]] const BsdfParameters& parameters() const { return parameters_; }
    [[nodiscard]] const BsdfFrame& frame() const { return frame_; }

  private:
    /// A normal that a map turned.
    struct Turn {
        Vec3d from, to;
        double alpha2;
    };
    void turn_normal(Vec3d local, Vec3d along, Vec3d wo);
    void choose_parts();
    /// How much of the light from wi reaches a surface whose normal was turned by maps, and 0 where the
    /// turned and the original surface disagree about wi's side.
    [[nodiscard]] double map_shadowing(Vec3d wi) const;
    [[nodiscard]] double radiance_scale(double eta) const;

    BsdfParameters parameters_;
    BsdfFrame frame_;
    Vec3d wo_;  ///< in the frame; z > 0
    bool scales_radiance_;
    const SpecularModel* specular_ = nullptr;
    double diffuse_chance_ = 0, specular_chance_ = 0;
    std::array<Turn, NEARLIGHT_MAX_BSDF_NESTING + 1> turns_{};
    std::size_t turn_count_ = 0;
};

}  // namespace nearlight::core
