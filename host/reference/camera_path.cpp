// SPDX-License-Identifier: Apache-2.0
#include "host/reference/camera_path.h"

#include "host/base/math.h"
#include "host/reference/lobe.h"
#include "host/reference/surface.h"
#include "host/scene/ray_epsilon.h"

namespace nearlight::core {
namespace {

LobeRandom lobe_random(SampleBatch& batch, int sample, int vertex) {
    if (vertex == 0) {
        return {batch.number(Decision::lobe, sample), batch.point(Decision::lobe_direction, sample)};
    }
    Pcg32& random = batch.random();
    const float choice = random.uniform();
    const float x = random.uniform();
    return {choice, {x, random.uniform()}};
}

bool acts_on_light(const Surface& surface) {
    // Glass acts from both sides whatever its flag says.
    return surface.reflects() || is_glass(*surface.material);
}

}  // namespace

CameraRays::CameraRays(const SceneCamera& camera, int width, int height)
    : to_world_(camera.to_world),
      tan_x_(std::tan(camera.fov_x_degrees * std::numbers::pi / 360.0)),
      tan_y_(tan_x_ * height / width),
      width_(width),
      height_(height) {}

Ray CameraRays::through(float x, float y) const {
    const Vec3 direction{static_cast<float>((1.0 - 2.0 * x / width_) * tan_x_),
                         static_cast<float>((1.0 - 2.0 * y / height_) * tan_y_), 1.0f};
    return {transform_point(to_world_, {0, 0, 0}), normalize(transform_vector(to_world_, direction))};
}

CameraPath trace_camera_path(const Scene& scene, const EmbreeScene& embree, const LightSampler& lights,
                             Ray ray, SampleBatch& batch, int sample) {
    CameraPath path;
    for (int vertex = 0; vertex < kMaxCameraVertices; ++vertex) {
        const BvhHit hit = embree.closest_visible_hit(ray.origin, ray.direction, 0.0f, kInfinity);
        if (hit.triangle == ~0u) {
            path.emitted += path.throughput * lights.environment_radiance(ray.direction);
            return path;
        }
        if (vertex == 0) {
            path.depth = hit.t;
        }
        path.emitted += path.throughput * lights.emitted_radiance(hit.triangle, ray.direction);
        const Surface surface = surface_at(scene, hit, ray.direction);
        if (!acts_on_light(surface)) {
            return path;
        }
        const LobeSample lobe = sample_lobe(surface, -ray.direction, lobe_random(batch, sample, vertex));
        path.throughput *= lobe.weight;
        if (lobe.is_base) {
            path.has_receiver = true;
            path.receiver = {stand_off(surface.position, surface.geometric_normal, lights.extent()),
                             surface.shading_normal,
                             camera_albedo(scene, *surface.material, surface.u, surface.v)};
            return path;
        }
        if (is_zero(path.throughput)) {
            return path;
        }
        const bool stays = dot(lobe.direction, surface.geometric_normal) > 0.0f;
        const Vec3 side = stays ? surface.geometric_normal : -surface.geometric_normal;
        ray = {stand_off(surface.position, side, lights.extent()), lobe.direction};
    }
    return path;
}

}  // namespace nearlight::core
