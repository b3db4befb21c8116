// SPDX-License-Identifier: Apache-2.0
#include "host/reference/bsdf/surface_bsdf.h"

#include "host/reference/bsdf/lookup.h"

namespace nearlight::core {
namespace {

// A part of a BSDF is drawn from with this probability at least, however dark it is estimated.
constexpr double kMinPartChance = 0.1;

/// The right-handed frame about the unit vector n whose x axis is as near to `along` as can be.
BsdfFrame frame_along(Vec3d n, Vec3d along) {
    Vec3d s = along - n * dot(n, along);
    if (length(s) <= 1e-9 * length(along) || is_zero(along)) {
        s = as_double(orthonormal_basis(as_float(n))[0]);
        s = s - n * dot(n, s);
    }
    s = normalize(s);
    return {s, cross(n, s), n};
}

/// The frame of the surface on its front; its x axis follows the texture coordinate u where there is one, and
/// its y axis goes against v where (u, v) is mirrored, as in Mitsuba.
BsdfFrame front_frame(const Surface& surface) {
    return frame_along(normalize(as_double(surface.front_normal)), as_double(surface.along_u));
}

/// The squared tangent of the angle to the axis whose cosine is given.
double tangent2(double cosine) {
    const double cosine2 = cosine * cosine;
    return (1 - std::min(1.0, cosine2)) / std::max(cosine2, 1e-12);
}

}  // namespace

BsdfRandom even_random(int index) {
    constexpr double kGrowth = 1.2207440846057596;  // x⁴ = x + 1
    const auto fraction = [&](double step) {
        const double turns = 0.5 + step * index;
        return turns - std::floor(turns);
    };
    return {fraction(1 / (kGrowth * kGrowth * kGrowth)), fraction(1 / kGrowth),
            fraction(1 / (kGrowth * kGrowth))};
}

SurfaceBsdf::SurfaceBsdf(const Scene& scene, const Surface& surface, Vec3d wo, double choice,
                         Transport transport)
    : frame_(front_frame(surface)), scales_radiance_(transport != Transport::flux && !scene.clear_glass) {
    const Material* material = surface.material;
    const BsdfFrame flat = frame_;
    for (int step = 0; step <= NEARLIGHT_MAX_BSDF_NESTING; ++step) {
        const Material& m = *material;
        uint child = m.child[0];
        if (m.model == NEARLIGHT_BSDF_MASK || m.model == NEARLIGHT_BSDF_BLEND) {
            const double share = share_at(scene, surface, m);
            const bool first = choice < share;
            choice = first ? choice / share : (choice - share) / (1 - share);
            if (m.model == NEARLIGHT_BSDF_MASK && !first) {
                parameters_.model = NEARLIGHT_BSDF_NULL;
                break;
            }
            child = m.model == NEARLIGHT_BSDF_BLEND && first ? m.child[1] : m.child[0];
        } else if (m.model == NEARLIGHT_BSDF_TWO_SIDED) {
            if (dot(wo, frame_.n) < 0) {
                frame_.n = -frame_.n;
                child = m.child[1];
            }
        } else if (m.model == NEARLIGHT_BSDF_NORMAL_MAP) {
            turn_normal(mapped_normal(scene, surface, m), {1, 0, 0}, wo);
        } else if (m.model == NEARLIGHT_BSDF_BUMP_MAP) {
            turn_normal(bumped_normal(scene, surface, m, flat), as_double(surface.along_u), wo);
        } else {
            parameters_ = bsdf_parameters(scene, surface, m, dot(wo, frame_.n) > 0);
            if (scene.clear_glass && transport != Transport::camera && m.model == NEARLIGHT_BSDF_DIELECTRIC &&
                is_smooth(parameters_)) {
                parameters_.model = NEARLIGHT_BSDF_CLEAR_GLASS;
                parameters_.eta = as_double(m.eta);
            }
            break;
        }
        material = &scene.materials[child];
    }
    if (dot(wo, frame_.n) < 0) {
        frame_.n = -frame_.n;
    }
    wo_ = frame_.to_local(wo);
    choose_parts();
}

// As in Mitsuba, a normal that faces away from the viewer is turned half way round the normal of the surface,
// and the new x axis is as near to `along` as can be. Mitsuba gives bump maps the derivative by u in the
// world for it, though the rest is given in the frame of the surface.
void SurfaceBsdf::turn_normal(Vec3d local, Vec3d along, Vec3d wo) {
    const Vec3d view = frame_.to_local(wo);
    if (view.z * dot(view, local) <= 0) {
        local = {-local.x, -local.y, local.z};
    }
    const auto [s, t, n] = frame_along(local, along);
    turns_[turn_count_++] = {frame_.n, frame_.to_world(local), std::min(1.0, 0.125 * tangent2(local.z))};
    frame_ = {frame_.to_world(s), frame_.to_world(t), frame_.to_world(n)};
}

void SurfaceBsdf::choose_parts() {
    specular_ = specular_model(parameters_);
    if (wo_.z <= 0) {
        specular_ = nullptr;
        return;
    }
    const double diffuse = max_component(diffuse_reflectance());
    const double specular = specular_ != nullptr ? max_component(specular_->estimate(parameters_, wo_)) : 0;
    if (diffuse > 0 && specular > 0) {
        specular_chance_ = std::clamp(specular / (diffuse + specular), kMinPartChance, 1 - kMinPartChance);
        diffuse_chance_ = 1 - specular_chance_;
    } else {
        diffuse_chance_ = diffuse > 0 ? 1 : 0;
        specular_chance_ = specular > 0 ? 1 : 0;
    }
}

Vec3d SurfaceBsdf::diffuse_reflectance() const {
    return wo_.z > 0 ? parameters_.diffuse * base_transmittance(parameters_, wo_.z) : Vec3d{};
}

// [Estevez, Lecocq and Stein, A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem, Ray
// Tracing Gems 2019]
double SurfaceBsdf::map_shadowing(Vec3d wi) const {
    double factor = 1;
    for (std::size_t i = 0; i < turn_count_; ++i) {
        const Turn& turn = turns_[i];
        const double cosine = dot(wi, turn.from);
        if (cosine * dot(wi, turn.to) <= 0) {
            return 0;
        }
        factor *= 2 / (1 + std::sqrt(1 + turn.alpha2 * tangent2(cosine)));
    }
    return factor;
}

double SurfaceBsdf::radiance_scale(double eta) const {
    return scales_radiance_ ? 1 / (eta * eta) : 1;
}

BsdfValue SurfaceBsdf::eval(Vec3d wi) const {
    const Vec3d local = frame_.to_local(wi);
    const double shadowing = map_shadowing(wi);
    BsdfValue value;
    if (shadowing == 0) {
        return value;
    }
    if (has_diffuse()) {
        value.diffuse = eval_diffuse(parameters_, wo_, local) * shadowing;
    }
    if (has_specular()) {
        const bool enters = local.z < 0 && !parameters_.thin;
        const double eta = enters ? parameters_.eta.x : 1;
        value.specular = specular_->eval(parameters_, wo_, local) * shadowing;
        // A perfect mirror has the index 0, but lets no light enter.
        if (!is_zero(value.specular)) {
            value.specular *= radiance_scale(eta);
        }
    }
    return value;
}

double SurfaceBsdf::diffuse_pdf(Vec3d wi) const {
    return has_diffuse() && map_shadowing(wi) > 0 ? cosine_pdf(frame_.to_local(wi)) : 0;
}

double SurfaceBsdf::specular_pdf(Vec3d wi) const {
    return has_specular() && map_shadowing(wi) > 0 ? specular_->pdf(parameters_, wo_, frame_.to_local(wi))
                                                   : 0;
}

double SurfaceBsdf::pdf(Vec3d wi) const {
    return diffuse_chance_ * diffuse_pdf(wi) + specular_chance_ * specular_pdf(wi);
}

SurfaceDraw SurfaceBsdf::sample_diffuse(BsdfRandom random) const {
    SurfaceDraw draw;
    draw.is_diffuse = true;
    const Vec3d local = sample_cosine(random.x, random.y);
    draw.wi = frame_.to_world(local);
    draw.pdf = diffuse_pdf(draw.wi);
    if (draw.pdf > 0) {
        draw.weight = eval_diffuse(parameters_, wo_, local) * (map_shadowing(draw.wi) / draw.pdf);
    }
    return draw;
}

SurfaceDraw SurfaceBsdf::sample_specular(BsdfRandom random) const {
    SurfaceDraw draw;
    if (!has_specular()) {
        return draw;
    }
    static_cast<BsdfDraw&>(draw) = specular_->sample(parameters_, wo_, random);
    draw.wi = frame_.to_world(draw.wi);
    const double shadowing = map_shadowing(draw.wi);
    draw.weight *= shadowing * radiance_scale(draw.eta);
    draw.pdf = shadowing > 0 ? draw.pdf : 0;
    draw.is_straight = draw.is_straight && turn_count_ == 0;  // maps block shadow rays
    return draw;
}

SurfaceDraw SurfaceBsdf::sample(double part, BsdfRandom random) const {
    const bool diffuse = part < diffuse_chance_;
    SurfaceDraw draw = diffuse ? sample_diffuse(random) : sample_specular(random);
    const double chance = diffuse ? diffuse_chance_ : specular_chance_;
    if (chance > 0) {
        draw.weight *= 1 / chance;
        draw.pdf *= chance;
    }
    return draw;
}

BsdfValue SurfaceBsdf::albedo(int samples) const {
    BsdfValue sum;
    const bool is_delta = has_specular() && specular_->sample(parameters_, wo_, {}).is_delta;
    const double scale = 1.0 / samples;
    for (int i = 0; i < samples; ++i) {
        const BsdfRandom random = even_random(i);
        sum.diffuse += has_diffuse() ? sample_diffuse(random).weight * scale : Vec3d{};
        if (has_specular() && !is_delta) {
            const BsdfDraw draw = specular_->sample(parameters_, wo_, random);
            sum.specular += draw.weight * (scale * map_shadowing(frame_.to_world(draw.wi)));
        }
    }
    if (is_delta) {
        sum.specular = specular_->estimate(parameters_, wo_);
    }
    return sum;
}

}  // namespace nearlight::core
