// SPDX-License-Identifier: Apache-2.0
// Which triangles reach into the close range. Kernels: triangle_classifier.cl.
#pragma once

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

class TriangleClassifier {
  public:
    explicit TriangleClassifier(Device& device);

    /// For each triangle: flag 1 if some point of it is in the close range (glass and triangles without area
    /// never are), and the area of all of it, m². `range` holds one element. The outputs have one element a
    /// triangle.
    void classify(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles,
                  const Buffer<Material>& materials, const Buffer<CloseRange>& range,
                  std::size_t triangle_count, Buffer<uint>& flags, Buffer<float>& areas);

    /// centroids[i] of triangle ids[i], i < count: what the triangles are put in Morton order by.
    void centroids(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles, const Buffer<uint>& ids,
                   std::size_t count, Buffer<Vec3>& centroids);

  private:
    Program program_;
    Kernel classify_;
    Kernel centroids_;
};

}  // namespace nearlight::core
