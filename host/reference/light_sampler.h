// SPDX-License-Identifier: Apache-2.0
// Direct light in the reference path tracer: by sampling the scene's lights, and by hitting them.
#pragma once

#include <vector>

#include "host/reference/embree_scene.h"
#include "host/reference/sampling.h"
#include "host/scene/emitters.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// Irradiance (W/m²) that a point or spot light sends to a point that stands off its surface; 0 for emitters
/// of other types.
Vec3 delta_light_irradiance(const EmbreeScene& embree, const Emitter& emitter, Vec3 position, Vec3 normal);

/// Uniform random numbers in [0, 1): `pick` chooses a light, `place` a place on it.
struct LightRandom {
    float pick = 0.0f;
    Point2 place;
};

/// Multiple importance sampling by the balance heuristic [Veach and Guibas 1995]: the expectation of
/// `sampled_irradiance` plus π · `met_radiance` of one cosine-distributed ray is the direct irradiance.
/// The scene must outlive the sampler.
class LightSampler {
  public:
    explicit LightSampler(const Scene& scene);

    /// Estimate of the irradiance (W/m²) at a point that stands off its surface, about the unit normal. It
    /// sums all point and spot lights where they are few, otherwise one of them, and one place on an area
    /// light or in the environment.
    [[nodiscard]] Vec3 sampled_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                          LightRandom random) const;
    /// Weighted radiance that a cosine-distributed ray about `normal` brings from the triangle that it hits,
    /// or from the environment if it hits none. `direction` is a unit vector.
    [[nodiscard]] Vec3 met_radiance(const BvhHit& hit, Vec3 direction, Vec3 normal) const;

    /// Radiance that arrives from the environment; `direction` is a unit vector that points towards it. The
    /// nearest pixel counts; without an environment the radiance is 0. Longitude follows Mitsuba: in local
    /// space the first column begins at −Z, and columns to the right turn towards +X.
    [[nodiscard]] Vec3 environment_radiance(Vec3 direction) const;
    /// Radiance that the triangle sends towards the origin of a ray with the given direction. Only its front
    /// emits.
    [[nodiscard]] Vec3 emitted_radiance(uint triangle, Vec3 direction) const;

    [[nodiscard]] float extent() const { return extent_; }

  private:
    struct Pixel {
        uint column = 0;
        uint row = 0;
    };
    [[nodiscard]] Vec3 delta_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                        float pick) const;
    [[nodiscard]] Vec3 triangle_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                           const Emitter& emitter, float probability, Point2 u) const;
    [[nodiscard]] Vec3 environment_irradiance(const EmbreeScene& embree, Vec3 position, Vec3 normal,
                                              float probability, LightRandom random) const;
    [[nodiscard]] Pixel pixel_towards(Vec3 direction) const;
    [[nodiscard]] float pixel_density(Pixel pixel) const;
    [[nodiscard]] Vec3 triangle_normal(uint triangle) const;

    const Scene& scene_;
    EmitterTable table_;
    EnvironmentTable environment_;
    float extent_ = 0.0f;
    float area_share_ = 0.0f;               ///< probability of all lights that are not point or spot lights
    float environment_probability_ = 0.0f;  ///< among those
    std::vector<float>
        triangle_density_;  ///< per triangle: probability among those ÷ area; empty: none emits
};

}  // namespace nearlight::core
