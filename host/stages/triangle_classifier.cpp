// SPDX-License-Identifier: Apache-2.0
#include "host/stages/triangle_classifier.h"

#include "host/stages/joint_programs.h"
#include "host/stages/runs.h"

namespace nearlight::core {

TriangleClassifier::TriangleClassifier(Device& device)
    : program_(device, "triangle_classifier.cl", kVplsProgram),
      classify_(program_, "classify_triangles"),
      centroids_(program_, "triangle_centroids") {}

void TriangleClassifier::classify(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles,
                                  const Buffer<Material>& materials, const Buffer<CloseRange>& range,
                                  bool whole_triangles, std::size_t triangle_count, Buffer<uint>& flags,
                                  Buffer<float>& areas) {
    classify_.launch_items(triangle_count, vertices, triangles, materials, range, whole_triangles ? 1u : 0u,
                           flags, areas, to_kernel_count(triangle_count, "triangles"));
}

void TriangleClassifier::centroids(const Buffer<Vertex>& vertices, const Buffer<Triangle>& triangles,
                                   const Buffer<uint>& ids, std::size_t count, Buffer<Vec3>& centroids) {
    centroids_.launch_items(count, vertices, triangles, ids, centroids, to_kernel_count(count, "triangles"));
}

}  // namespace nearlight::core
