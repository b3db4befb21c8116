// SPDX-License-Identifier: Apache-2.0
#include "host/reference/bsdf/lookup.h"

#include <algorithm>

#include "host/scene/number_pair.h"
#include "host/scene/texture.h"

namespace nearlight::core {
namespace {

double luminance_of(Vec3d color) {
    return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z;
}

/// Looks the parameters of one material up.
struct Lookup {
    const Scene& scene;
    const Surface& surface;

    [[nodiscard]] Vec3d color(const Parameter& parameter) const {
        const Vec3 value = value_at(scene, surface, parameter);
        return as_double(max(value, Vec3{0, 0, 0}));
    }
    /// Two numbers in [0, 1], in x and y. A texture scales both by the luminance of its colour, as in
    /// Mitsuba, or, if it was made of one texture for each, by its red and its green.
    [[nodiscard]] Vec3d numbers(const Parameter& parameter) const {
        const Vec3d texel = color({{1, 1, 1}, parameter.texture});
        const bool has_two = holds_two_numbers(scene, parameter);
        const double grey = luminance_of(texel);
        return {std::clamp(parameter.value.x * (has_two ? texel.x : grey), 0.0, 1.0),
                std::clamp(parameter.value.y * (has_two ? texel.y : grey), 0.0, 1.0), 0};
    }
    /// A number in [0, 1].
    [[nodiscard]] double number(const Parameter& parameter) const { return numbers(parameter).x; }
};

/// The base below a coat: light bounces between them, and what the coat lets out is spread over 1/η².
Vec3d coated_base(Vec3d base, const Material& material) {
    const double inside = material.internal_reflectance;
    const double eta = material.eta.x;
    const bool nonlinear = (material.flags & NEARLIGHT_MATERIAL_NONLINEAR) != 0u;
    // A texel above 1 would make the light between the base and the coat grow without an end.
    const auto channel = [&](double x) {
        return x / ((1 - inside * (nonlinear ? std::min(x, 1.0) : 1)) * eta * eta);
    };
    return {channel(base.x), channel(base.y), channel(base.z)};
}

void look_up_principled(const Lookup& at, const Material& material, BsdfParameters& p) {
    p.base = at.color(material.reflectance);
    p.metallic = at.number(material.metallic);
    p.anisotropic = at.number(material.anisotropic);
    p.spec_trans = at.number(material.spec_trans);
    p.spec_tint = at.number(material.spec_tint);
    p.sheen = at.number(material.sheen);
    p.sheen_tint = at.number(material.sheen_tint);
    p.flatness = at.number(material.flatness);
    p.clearcoat = at.number(material.clearcoat);
    p.clearcoat_gloss = at.number(material.clearcoat_gloss);
    p.alpha_y = p.alpha_x;
    if (p.thin) {
        p.metallic = p.clearcoat = 0;
        p.transmission.x = at.number(material.transmission);
        p.diffuse = p.base * ((1 - p.spec_trans) * (1 - p.transmission.x) * (1 - p.flatness));
    } else if (p.front) {
        p.diffuse = p.base * ((1 - p.metallic) * (1 - p.spec_trans) * (1 - p.flatness));
    }
}

bool has_back(const BsdfParameters& p) {
    return p.model == NEARLIGHT_BSDF_DIELECTRIC || p.model == NEARLIGHT_BSDF_THIN_DIELECTRIC ||
           p.model == NEARLIGHT_BSDF_PRINCIPLED || p.model == NEARLIGHT_BSDF_NULL;
}

/// The change of a bump map's height from one half texel to the other, per unit of u or v.
Vec3d height_gradient(const Scene& scene, const Surface& surface, const Parameter& height) {
    if (height.texture < 0) {
        return {};
    }
    const SceneTexture& texture = scene.textures[static_cast<std::size_t>(height.texture)];
    // Mitsuba's checkerboards have no gradient, and neither have its bitmaps without interpolation.
    if (texture.image < 0 || texture.parameters.filter == NEARLIGHT_FILTER_NEAREST) {
        return {};
    }
    const TextureImage& image = scene.images[static_cast<std::size_t>(texture.image)];
    const Texture& p = texture.parameters;
    // Between the centres of four texels the height is bilinear, so its slopes follow from the middles of the
    // cell's edges at the same s or t. Textures are placed by an affine map, whose inverse leads from there.
    const double s = double(p.u_scale) * surface.u + double(p.u_shear) * surface.v + p.u_offset;
    const double t = double(p.v_shear) * surface.u + double(p.v_scale) * surface.v + p.v_offset;
    const double determinant = double(p.u_scale) * p.v_scale - double(p.u_shear) * p.v_shear;
    if (determinant == 0) {
        return {};
    }
    const auto height_at = [&](double s_there, double t_there) {
        const double a = s_there - p.u_offset;
        const double b = t_there - p.v_offset;
        const Vec3 texel =
            texture_color(scene, texture, static_cast<float>((p.v_scale * a - p.u_shear * b) / determinant),
                          static_cast<float>((p.u_scale * b - p.v_shear * a) / determinant));
        return double{height.value.x} * luminance_of(as_double(texel));
    };
    constexpr double kReach = 0.25;  // texels, on either side of the cell's middle
    const auto slope_along = [&](double place, int texels, const auto& height_there) {
        const double middle = (std::floor(place * texels - 0.5) + 1.0) / texels;
        const double step = kReach / texels;
        return (height_there(middle + step) - height_there(middle - step)) / (2 * step);
    };
    const double by_s = slope_along(s, image.width, [&](double x) { return height_at(x, t); });
    const double by_t = slope_along(t, image.height, [&](double y) { return height_at(s, y); });
    return {by_s * p.u_scale + by_t * p.v_shear, by_s * p.u_shear + by_t * p.v_scale, 0};
}

}  // namespace

BsdfParameters bsdf_parameters(const Scene& scene, const Surface& surface, const Material& material,
                               bool front) {
    const Lookup at{scene, surface};
    BsdfParameters p;
    p.model = material.model;
    p.front = front;
    if (!front && !has_back(p)) {
        p.model = NEARLIGHT_BSDF_DIFFUSE;
        return p;
    }
    p.beckmann = (material.flags & NEARLIGHT_MATERIAL_BECKMANN) != 0u;
    p.thin = (material.flags & NEARLIGHT_MATERIAL_THIN) != 0u;
    p.layered = (material.flags & NEARLIGHT_MATERIAL_LAYERED) != 0u;
    p.specular = at.color(material.specular);
    p.transmission = at.color(material.transmission);
    const Vec3d roughness = at.numbers(material.roughness);
    p.alpha_x = roughness.x;
    p.alpha_y = roughness.y;
    p.eta = as_double(material.eta);
    p.k = as_double(material.k);
    p.curve = std::span(scene.transmission_curves)
                  .subspan(material.curve * std::size_t{NEARLIGHT_CURVE_SIZE}, NEARLIGHT_CURVE_SIZE);
    const bool is_body = p.model == NEARLIGHT_BSDF_DIELECTRIC || p.model == NEARLIGHT_BSDF_PRINCIPLED;
    if (is_body && !front && !p.thin) {
        p.eta.x = 1 / p.eta.x;
    }
    if (p.model == NEARLIGHT_BSDF_DIFFUSE || p.model == NEARLIGHT_BSDF_PHONG ||
        p.model == NEARLIGHT_BSDF_WARD) {
        p.diffuse = at.color(material.reflectance);
    } else if (p.model == NEARLIGHT_BSDF_PLASTIC) {
        p.diffuse = coated_base(at.color(material.reflectance), material);
    } else if (p.model == NEARLIGHT_BSDF_PRINCIPLED) {
        look_up_principled(at, material, p);
    }
    return p;
}

double share_at(const Scene& scene, const Surface& surface, const Material& material) {
    return Lookup{scene, surface}.number(material.reflectance);
}

Vec3d mapped_normal(const Scene& scene, const Surface& surface, const Material& material) {
    const Vec3d value = as_double(value_at(scene, surface, material.reflectance));
    const Vec3d normal = value * 2 - Vec3d{1, 1, 1};
    const double squared = dot(normal, normal);
    return squared > 0 && std::isfinite(squared) ? normalize(normal) : Vec3d{0, 0, 1};
}

Vec3d bumped_normal(const Scene& scene, const Surface& surface, const Material& material,
                    const BsdfFrame& frame) {
    const Vec3d slope = height_gradient(scene, surface, material.reflectance);
    const Vec3d n = frame.n;
    const Vec3d along_u = as_double(surface.along_u);
    const Vec3d along_v = as_double(surface.along_v);
    const Vec3d normal = normalize(
        cross(along_u + n * (slope.x - dot(n, along_u)), along_v + n * (slope.y - dot(n, along_v))));
    if (is_zero(normal)) {
        return {0, 0, 1};
    }
    const Vec3d front = as_double(surface.front ? surface.geometric_normal : -surface.geometric_normal);
    return frame.to_local(dot(normal, front) < 0 ? -normal : normal);
}

}  // namespace nearlight::core
