// SPDX-License-Identifier: Apache-2.0
// Rays of the camera, and what a path from the camera finds besides light.
#pragma once

#include <limits>
#include <vector>

#include "host/base/math.h"
#include "host/reference/sampling.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace nearlight::core {

struct Ray {
    Vec3 origin;
    Vec3 direction;      ///< unit vector
    float t_min = 0.0f;  ///< where surfaces are met
    float t_max = std::numeric_limits<float>::infinity();
};

/// A place on the film, and the weight of what is seen through it.
struct FilterPoint {
    Point2 place;  ///< pixels from the top left corner
    double weight = 1.0;
};

/// Rays through the film of a SceneCamera at any size in pixels. The horizontal angle of view stays the
/// camera's.
class CameraRays {
  public:
    CameraRays(const SceneCamera& camera, int width, int height);
    /// The ray through a film position, in pixels from the top left corner. A thin lens has it start at the
    /// place on the lens that the random point `lens` stands for.
    [[nodiscard]] Ray through(Point2 film, Point2 lens) const;

  private:
    SceneCamera camera_;
    PictureWindow window_;
};

/// Places the samples of pixels by the camera's reconstruction filter.
class FilterSampler {
  public:
    FilterSampler(const SceneCamera& camera, int width, int height);
    /// The place in pixel (x, y) or around it that the random point `u` stands for.
    [[nodiscard]] FilterPoint sample(int x, int y, Point2 u) const;

  private:
    /// Sums from −radius up to each border between cells.
    struct Sums {
        double absolute = 0.0, signed_sum = 0.0;
    };
    [[nodiscard]] Sums sums_at(double offset) const;
    [[nodiscard]] double along_axis(double middle, double film_size, double u, double& weight) const;

    bool is_box_;
    bool sample_border_;
    double radius_;
    double width_, height_;
    std::vector<Sums> sums_;
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
