// SPDX-License-Identifier: Apache-2.0
// The environment in the reference path tracer: its radiance, and directions chosen by its tables.
#pragma once

#include "host/reference/sampling.h"
#include "host/scene/environment_map.h"
#include "host/scene/environment_table.h"

namespace nearlight::core {

class EnvironmentSampler {
  public:
    explicit EnvironmentSampler(const Scene& scene);

    [[nodiscard]] bool exists() const { return table_.parameters.width > 0; }
    /// The radius of the sphere around the scene, m.
    [[nodiscard]] float scene_radius() const { return table_.parameters.scene_radius; }

    /// Radiance that arrives from the environment; `direction` is a unit vector that points towards it. It
    /// is interpolated between pixels where the map is, and the sun counts; without an environment the
    /// radiance is 0. Longitude follows Mitsuba: in local space the first column begins at −Z, and columns to
    /// the right turn towards +X.
    [[nodiscard]] Vec3 radiance(Vec3 direction) const;
    /// Density per steradian with which sample() chooses a direction; 0 without an environment.
    [[nodiscard]] double density(Vec3 direction) const;
    /// Density per steradian with which sample_sun() chooses a direction; 0 beside the sun.
    [[nodiscard]] double sun_density(Vec3 direction) const;
    /// A direction that is uniform over the sun's disc.
    [[nodiscard]] Vec3 sample_sun(Point2 place) const;

    /// A direction chosen by luminance, pixel by pixel. `row` and `place` are uniform in [0, 1). There must
    /// be an environment.
    [[nodiscard]] Vec3 sample(float row, Point2 place) const;

  private:
    [[nodiscard]] Vec3 to_local(Vec3 direction) const;
    [[nodiscard]] Vec3 map_radiance(Vec3 direction) const;
    [[nodiscard]] MapShape shape() const;
    [[nodiscard]] double pixel_density(MapPixel pixel) const;

    EnvironmentTable table_;
    // Cumulative distributions of the rows of pixels, and of the pixels of each row: other ones than kernels
    // have.
    std::vector<float> row_cdf_;
    std::vector<float> column_cdf_;
};

}  // namespace nearlight::core
