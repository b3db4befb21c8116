// SPDX-License-Identifier: Apache-2.0
// From the camera over mirrors, metals, coats and glass to the receiver.
#pragma once

#include "host/reference/embree_scene.h"
#include "host/reference/light_sampler.h"
#include "host/reference/sample_batch.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct Ray {
    Vec3 origin;
    Vec3 direction;  ///< unit
};

/// Rays through the film of a SceneCamera at a size of its own; the horizontal angle of view stays.
class CameraRays {
  public:
    CameraRays(const SceneCamera& camera, int width, int height);
    /// Through film position (x, y) in pixels, (0, 0) the top left corner.
    [[nodiscard]] Ray through(float x, float y) const;

  private:
    Mat4 to_world_;
    double tan_x_, tan_y_;
    int width_, height_;
};

/// A point that light is gathered at.
struct Receiver {
    Vec3 position;  ///< stands off its surface on the viewer's side
    Vec3 normal;    ///< shading normal on the viewer's side
    Vec3 albedo;    ///< Lambertian, without the coat
};

struct CameraPath {
    Vec3 emitted{0, 0, 0};     ///< radiance of lights and environment met on the way, weighted
    Vec3 throughput{1, 1, 1};  ///< of light that leaves the receiver
    float depth = 0.0f;        ///< distance to the first surface, m; 0: none
    bool has_receiver = false;
    Receiver receiver;
};

/// Surfaces that a path visits at most before it is given up as black.
inline constexpr int kMaxCameraVertices = 24;

/// One path, lobes chosen by chance. Refraction does not scale radiance, for light does not see glass.
CameraPath trace_camera_path(const Scene& scene, const EmbreeScene& embree, const LightSampler& lights,
                             Ray ray, SampleBatch& batch, int sample);

}  // namespace nearlight::core
