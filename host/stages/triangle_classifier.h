// SPDX-License-Identifier: Apache-2.0
// Finds the triangles that reach into the close range. The kernels are in triangle_classifier.cl.
#pragma once

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

class TriangleClassifier {
  public:
    explicit TriangleClassifier(Device& device);

    /// Writes a flag and an area (m²) for each triangle. The flag is 1 if some point of the triangle is in
    /// the close range; it is 0 for triangles without a Lambertian part and for those without area. The area
    /// is that of the whole triangle or, unless `whole_triangles`, of what the planes of the close range
    /// leave of a triangle whose flag is 1. `range` holds one element, and the outputs hold one element per
    /// triangle.
    void classify(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles,
                  const Buffer<Material>& materials, const Buffer<CloseRange>& range, bool whole_triangles,
                  std::size_t triangle_count, Buffer<uint>& flags, Buffer<float>& areas);

    /// Sets centroids[i] to the centroid of triangle ids[i] for all i < count. Triangles are put in Morton
    /// order by their centroids.
    void centroids(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles, const Buffer<uint>& ids,
                   std::size_t count, Buffer<Vec3>& centroids);

  private:
    Program program_;
    Kernel classify_;
    Kernel centroids_;
};

}  // namespace nearlight::core
