// SPDX-License-Identifier: Apache-2.0
// Rays of the camera, and what a path from the camera finds besides light.
#pragma once

#include "host/base/math.h"
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

/// The first point of a camera path that scatters light by D, the Lambertian part of its BSDF. The path came
/// there by way of S: mirrors, metals, coats and glass.
struct Receiver {
    Vec3 position;  ///< a small distance off its surface, on the viewer's side
    Vec3 normal;    ///< shading normal on the viewer's side
    Vec3 albedo;    ///< reflectance of D towards the viewer, divided by the chance with which D was taken
};

/// What a path from the camera found.
struct CameraPath {
    Vec3 throughput{1, 1, 1};  ///< weight of the light that leaves the receiver
    float depth = 0.0f;        ///< distance to the first surface, m; 0: the path met none
    bool has_receiver = false;
    Receiver receiver;
};

}  // namespace nearlight::core
