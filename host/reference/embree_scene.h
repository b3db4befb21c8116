// SPDX-License-Identifier: Apache-2.0
// Ray queries by Embree: the oracle of every other ray caster, and the engine of the path tracer.
#pragma once

#include <cstdint>
#include <memory>

#include "host/base/math.h"
#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct EmbreeOptions {
    enum class Quality { low, medium, high };
    Quality quality = Quality::medium;
    bool robust = true;     ///< watertight edges; a little slower
    bool coherent = false;  ///< successive rays are alike
};

/// Sixteen rays, component by component, as Embree lays them out. After a query, t_max of each occluded ray
/// is −∞. Directions need not be normalised; t counts in multiples of their length.
struct alignas(64) Rays16 {
    float origin_x[16], origin_y[16], origin_z[16];
    float t_min[16];
    float direction_x[16], direction_y[16], direction_z[16];
    float time[16];
    float t_max[16];
    std::uint32_t mask[16], id[16], flags[16];
};

/// The triangles of a scene. All materials count alike, glass and masks too. It keeps copies, so the scene
/// may be destroyed. Any number of threads may query it at once. Rays with a NaN or infinite component, or
/// with a zero direction, hit nothing.
class EmbreeScene {
  public:
    /// Throws Error with Embree's message: ErrorKind::out_of_memory or ErrorKind::failure.
    explicit EmbreeScene(const Scene& scene, const EmbreeOptions& options = {});
    ~EmbreeScene();
    EmbreeScene(EmbreeScene&&) noexcept;
    EmbreeScene& operator=(EmbreeScene&&) noexcept;

    /// Closest hit on either side of a triangle, with t between t_min and t_max.
    [[nodiscard]] BvhHit closest_hit(Vec3 origin, Vec3 direction, float t_min, float t_max) const;
    /// Whether any triangle is hit with t between t_min and t_max.
    [[nodiscard]] bool occluded(Vec3 origin, Vec3 direction, float t_min, float t_max) const;
    /// Whether a triangle cuts the segment between two points that already stand off their surfaces:
    /// t in (1e-5, 1 − 1e-5) of its length.
    [[nodiscard]] bool blocked(Vec3 from, Vec3 to) const;
    /// Queries the rays whose bits are set in `active`, and returns the bits of those that are occluded.
    std::uint32_t occluded16(Rays16& rays, std::uint32_t active) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight::core
