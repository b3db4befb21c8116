// SPDX-License-Identifier: Apache-2.0
#include "host/reference/bsdf/veil.h"

#include "host/reference/bsdf/fresnel.h"
#include "host/reference/bsdf/lookup.h"

namespace nearlight::core {
namespace {

/// The way of light through one surface.
struct VeilCrossing {
    const Scene& scene;
    const Surface& surface;
    double cosine;  ///< of the direction's angle to the shading normal, at least 0

    /// What one face lets through, with the index of the body over that outside.
    [[nodiscard]] double face(const Material& material) const {
        return 1 - fresnel_of_dielectric(cosine, static_cast<double>(material.eta.x));
    }
    [[nodiscard]] Vec3d of_model(const Material& material) const {
        const BsdfParameters p = bsdf_parameters(scene, surface, material, true);
        const double through = face(material);
        switch (material.model) {
            case NEARLIGHT_BSDF_NULL:
                return {1, 1, 1};
            case NEARLIGHT_BSDF_THIN_DIELECTRIC:
                return p.transmission * (through / (2 - through));  // t·t + t·r²·t + t·r⁴·t + …
            case NEARLIGHT_BSDF_DIELECTRIC:
                return scene.clear_glass && is_smooth(p) ? p.transmission * through : Vec3d{};
            default:
                return {};
        }
    }
    /// `from_front`: light comes to the viewer's side of the material from its front.
    [[nodiscard]] Vec3d of(const Material& material, bool from_front, int nesting = 0) const {
        if (nesting > NEARLIGHT_MAX_BSDF_NESTING) {
            return {};
        }
        const auto child = [&](int i) {
            return of(scene.materials[material.child[i]], from_front, nesting + 1);
        };
        switch (material.model) {
            case NEARLIGHT_BSDF_MASK: {
                const double opacity = share_at(scene, surface, material);
                return mix(Vec3d{1, 1, 1}, child(0), opacity);
            }
            case NEARLIGHT_BSDF_BLEND:
                return mix(child(0), child(1), share_at(scene, surface, material));
            case NEARLIGHT_BSDF_TWO_SIDED:
                return of(scene.materials[material.child[from_front ? 0 : 1]], true, nesting + 1);
            case NEARLIGHT_BSDF_NORMAL_MAP:
            case NEARLIGHT_BSDF_BUMP_MAP:
                return {};
            default:
                return of_model(material);
        }
    }
};

}  // namespace

Vec3d veil_transmittance(const Scene& scene, const Surface& surface, Vec3d direction) {
    const double along = dot(direction, as_double(surface.front_normal));
    if (along == 0) {
        return {};
    }
    const VeilCrossing crossing{scene, surface, std::abs(along)};
    return crossing.of(*surface.material, along < 0);
}

}  // namespace nearlight::core
