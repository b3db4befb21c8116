// SPDX-License-Identifier: Apache-2.0
// Paths from the camera by way of mirrors, metals, coats and glass to the receiver.
#pragma once

#include "host/reference/embree_scene.h"
#include "host/reference/light_sampler.h"
#include "host/reference/sample_batch.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct Ray {
    Vec3 origin;
    Vec3 direction;  ///< unit vector
};

/// Rays through the film of a SceneCamera at any size in pixels. The horizontal angle of view stays the
/// camera's.
class CameraRays {
  public:
    CameraRays(const SceneCamera& camera, int width, int height);
    /// The ray through film position (x, y) in pixels from the top left corner.
    [[nodiscard]] Ray through(float x, float y) const;

  private:
    Mat4 to_world_;
    double tan_x_, tan_y_;
    int width_, height_;
};

/// A point at which light is gathered.
struct Receiver {
    Vec3 position;  ///< a small distance off its surface, on the viewer's side
    Vec3 normal;    ///< shading normal on the viewer's side
    Vec3 albedo;    ///< albedo of the Lambertian base, without the coat
};

/// What a path from the camera found.
struct CameraPath {
    Vec3 emitted{0, 0, 0};     ///< weighted radiance of the lights and the environment met on the way
    Vec3 throughput{1, 1, 1};  ///< weight of the light that leaves the receiver
    float depth = 0.0f;        ///< distance to the first surface, m; 0: the path met none
    bool has_receiver = false;
    Receiver receiver;
};

/// Maximum number of surfaces that a path visits before it is given up as black.
inline constexpr int kMaxCameraVertices = 24;

/// Traces one path; lobes are chosen at random. Refraction does not scale radiance, because light passes
/// through glass as if it were not there.
CameraPath trace_camera_path(const Scene& scene, const EmbreeScene& embree, const LightSampler& lights,
                             Ray ray, SampleBatch& batch, int sample);

}  // namespace nearlight::core
