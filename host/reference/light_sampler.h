// SPDX-License-Identifier: Apache-2.0
// Direct light in the reference path tracer: by sampling the scene's lights, and by hitting them.
#pragma once

#include <array>
#include <span>

#include "host/reference/embree_scene.h"
#include "host/reference/environment_sampler.h"
#include "host/reference/sampling.h"
#include "host/scene/emitters.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// Irradiance (W/m²) that a delta light sends to a point that stands off its surface; 0 for emitters of other
/// types.
Vec3 delta_light_irradiance(const Scene& scene, const EmbreeScene& embree, const Emitter& emitter,
                            Vec3 position, Vec3 normal);

/// Uniform random numbers in [0, 1): `pick` chooses a light, `place` a place on it.
struct LightRandom {
    float pick = 0.0f;
    Point2 place;
};

/// Light that arrives from one direction, before visibility.
struct LightPick {
    Vec3 direction{0, 0, 1};  ///< unit vector towards the light
    Vec3 target{0, 0, 0};     ///< end of the shadow segment, stands off its surface; undefined if infinite
    Vec3 radiance{0, 0, 0};   ///< of a delta light: irradiance across the direction
    double density = 0.0;     ///< per steradian, with the probability of the light; delta: that alone
    bool infinite = false;    ///< the light comes from infinitely far away
    bool is_delta = false;
    bool can_be_met = false;  ///< a ray can find this light
};

/// Multiple importance sampling by the balance heuristic [Veach and Guibas 1995]: the expectation of
/// `sampled_irradiance` plus π · `met_radiance` of one cosine-distributed ray is the direct irradiance. For
/// other BSDFs, all direct light is the sum over exact_lights() of exact_light(), and of what sample()
/// estimates with the density pdf(). The scene must outlive the sampler.
class LightSampler {
  public:
    explicit LightSampler(const Scene& scene);

    /// The delta lights, if they are few enough to be summed all; otherwise none, and sample() has them too.
    [[nodiscard]] std::span<const Emitter> exact_lights() const;
    /// What the delta light sends to a point. A pick of no use has a black radiance.
    [[nodiscard]] static LightPick exact_light(const Scene& scene, const Emitter& emitter, Vec3 position);
    /// Light at a point from one of the lights that are not summed exactly. A pick of no use, as where there
    /// are none, has a black radiance.
    [[nodiscard]] LightPick sample(Vec3 position, LightRandom random) const;
    /// Density with which sample() picks the unit direction in which a ray from the position met `hit`
    /// (triangle ~0u: nothing); 0 where it cannot pick it.
    [[nodiscard]] double pdf(Vec3 position, Vec3 direction, const BvhHit& hit) const;
    /// Whether no opaque surface lies between the position and the light.
    [[nodiscard]] static bool is_visible(const EmbreeScene& embree, Vec3 position, const LightPick& pick);

    /// Estimate of the irradiance (W/m²) at a point that stands off its surface, about the unit normal. It
    /// sums exact_lights() and adds one pick of sample().
    [[nodiscard]] Vec3 sampled_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                          LightRandom random) const;
    /// Weighted radiance that a cosine-distributed ray about `normal` brings from the triangle that it hits,
    /// or from the environment if it hits none. `position` is where the ray starts, and `direction` is a unit
    /// vector.
    [[nodiscard]] Vec3 met_radiance(const BvhHit& hit, Vec3 position, Vec3 direction, Vec3 normal) const;

    /// Radiance that arrives from the environment in the unit direction towards it.
    [[nodiscard]] Vec3 environment_radiance(Vec3 direction) const { return environment_.radiance(direction); }
    /// Radiance that the point of a triangle sends towards the origin of a ray with the given direction. Only
    /// its front emits.
    [[nodiscard]] Vec3 emitted_radiance(const BvhHit& hit, Vec3 direction) const;

    /// Sides of the scene's bounds, m.
    [[nodiscard]] Vec3 scene_size() const { return scene_size_; }

  private:
    [[nodiscard]] LightPick triangle_pick(const Emitter& emitter, Vec3 position, Point2 u) const;
    [[nodiscard]] std::array<Vec3, 3> corners_of(uint triangle) const;
    [[nodiscard]] Vec3 triangle_normal(uint triangle) const;
    [[nodiscard]] const Emitter* emitter_of_triangle(uint triangle) const;
    /// Density with which sample() picks a direction in which nothing is met: that of the map and of the sun.
    [[nodiscard]] double distant_density(Vec3 direction) const;
    /// Probability with which sample() chooses the emitter.
    [[nodiscard]] double choice_probability(const Emitter& emitter) const;

    const Scene& scene_;
    EmitterTable table_;
    EnvironmentSampler environment_;
    Vec3 scene_size_;
    std::size_t sampled_first_ = 0;  ///< the first entry of the table that is not summed exactly
    double sampled_before_ = 0.0;    ///< probability of the entries before it
};

}  // namespace nearlight::core
