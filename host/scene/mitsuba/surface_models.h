// SPDX-License-Identifier: Apache-2.0
// Mitsuba's BSDFs of single surfaces, which hold no other BSDFs.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "host/scene/material_model.h"
#include "host/scene/mitsuba/texture_maker.h"

namespace nearlight::core::mitsuba {

/// A coat as Mitsuba 0.6 lays it over another BSDF.
struct Varnish {
    Material coat;                ///< a plastic with a black base, within which light is not reflected
    Vec3 transmittance{1, 1, 1};  ///< of what lies within the coat, for light straight down and up again
};

class SurfaceModels {
  public:
    static constexpr const char* kNames =
        "diffuse, roughdiffuse, plastic, roughplastic, conductor, roughconductor, dielectric, "
        "thindielectric, roughdielectric, principled, principledthin, phong, ward";

    SurfaceModels(Scene& scene, NoteSink& notes, TextureMaker& textures)
        : scene_(scene), notes_(notes), textures_(textures) {}

    /// The material, without emission, of a BSDF that kNames lists; nothing if its type is another. Throws
    /// Error(ErrorKind::file) where a value makes no sense.
    std::optional<Material> make(const Object& bsdf);
    /// The coat of a `coating` or `roughcoating`.
    Varnish make_varnish(const Object& bsdf);

  private:
    Material make_diffuse(const Object& bsdf);
    Material make_plastic(const Object& bsdf);
    /// A plastic with a white base, and with the index that the coat has where the file says none.
    Material make_coat(const Object& bsdf, double interior, bool nonlinear);
    Material make_conductor(const Object& bsdf);
    Material make_glass(const Object& bsdf);
    Material make_principled(const Object& bsdf);
    Material make_phong(const Object& bsdf);
    Material make_ward(const Object& bsdf);
    /// The two colours of Mitsuba 0.6's `phong` and `ward`.
    void read_base_and_lobe(const Object& bsdf, Material& material);
    void read_metal(const Object& bsdf, Material& material);
    double index_of_refraction(const Object& bsdf, const std::string& name, double fallback);
    /// The index, or `fallback` with a note if it makes no sense.
    double positive_index(double index, const Location& where, const std::string& name, double fallback);
    double index_ratio(const Object& bsdf, double interior);
    double index_of_specular(const Object& bsdf);
    double index_of_eta(const Object& bsdf);
    /// The index of a `principled` or `principledthin`.
    double principled_index(const Object& bsdf, bool transmits);
    /// The roughness of a `rough…` BSDF, and flags of its microfacets.
    void read_microfacets(const Object& bsdf, Material& material);
    /// The roughness from `alpha_u` and `alpha_v`, or from `alpha`.
    void read_roughness(const Object& bsdf, Material& material);
    Parameter anisotropic_alpha(const Object& bsdf);

    Scene& scene_;
    NoteSink& notes_;
    TextureMaker& textures_;
    std::map<Coat, Material> plastics_;
};

}  // namespace nearlight::core::mitsuba
