// SPDX-License-Identifier: Apache-2.0
// The light of single paths from the camera, by path tracing with multiple importance sampling.
#pragma once

#include "host/reference/bsdf/surface_bsdf.h"
#include "host/reference/camera_path.h"
#include "host/reference/embree_scene.h"
#include "host/reference/light_sampler.h"
#include "host/reference/sample_batch.h"

namespace nearlight::core {

/// What the light of one camera path is made of.
struct PathLight {
    /// Emission that is seen directly or by way of S, and light that is scattered once more at a vertex of
    /// that chain, by D at the receiver or by S.
    Vec3d direct;
    /// All other light; it reaches the receiver after one more scattering at least.
    Vec3d indirect;
    CameraPath camera;
};

/// Estimates the radiance that arrives along camera rays. Its expectation is that of Mitsuba 3's integrator
/// `path`: at every vertex one light is sampled and one direction is drawn from the BSDF, weighted by the
/// balance heuristic [Veach and Guibas 1995]; every surface counts for the depth. Shadow rays pass straight
/// through veils (shadow_ray.h), as paths do, which keep the density of the vertex before. Each of the parts
/// D and S of a BSDF is combined with light sampling by itself.
///
/// With a clamp radius R, a receiver gets its direct light and, of every other point y, only what y reflects
/// by D, with the geometry term bounded to 1/max(r², R²).
class PathIntegrator {
  public:
    /// @param max_depth number of vertices and emission: 1 is emission alone, 2 direct light too; 0 or less:
    /// no limit
    PathIntegrator(const Scene& scene, int max_depth, float clamp_radius);

    [[nodiscard]] PathLight trace(Ray ray, SampleBatch& batch, int sample) const;

  private:
    struct PathState;
    struct VertexRandom;
    static VertexRandom vertex_random(SampleBatch& batch, int sample, int vertex);

    [[nodiscard]] BvhHit first_hit(const Ray& ray) const;
    void add_emission(const PathState& state, const BvhHit& hit, PathLight& light) const;
    void add_sampled_light(const PathState& state, const Surface& surface, const SurfaceBsdf& bsdf,
                           const LightRandom& random, PathLight& light) const;
    [[nodiscard]] Vec3d scattered(const PathState& state, const Surface& surface, const SurfaceBsdf& bsdf,
                                  const LightPick& pick) const;
    static void leave(PathState& state, const SurfaceDraw& draw);
    [[nodiscard]] bool scatter(PathState& state, double distance, const Surface& surface,
                               const SurfaceBsdf& bsdf, const VertexRandom& random) const;
    void note_receiver(const PathState& state, const Surface& surface, const SurfaceBsdf& bsdf,
                       CameraPath& path) const;
    [[nodiscard]] bool only_diffuse(const PathState& state) const;
    [[nodiscard]] Vec3 beside(const Surface& surface, Vec3 direction) const;

    const Scene& scene_;
    int max_depth_;
    float clamp_radius_;
    EmbreeScene embree_;
    LightSampler lights_;
};

}  // namespace nearlight::core
