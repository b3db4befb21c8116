// SPDX-License-Identifier: Apache-2.0
#include "host/cli/memory_estimate.h"

#include <numeric>
#include <span>

#include "host/session/splat_rows.h"
#include "host/stages/splats.h"
#include "kernels/shared/camera_pass.h"
#include "kernels/shared/film_layers.h"

namespace nearlight::core {
namespace {

/// Vertices have colours and second coordinates only if textures are looked up there.
std::uint64_t texture_bytes(const Scene& scene) {
    const std::uint64_t of_vertices =
        std::span(scene.vertex_colors).size_bytes() + std::span(scene.second_uvs).size_bytes();
    return std::accumulate(scene.images.begin(), scene.images.end(), of_vertices,
                           [](std::uint64_t sum, const TextureImage& image) {
                               return sum + std::span(image.words).size_bytes();
                           });
}

/// The bytes of a pixel's splats on the device, with the default settings: those of samples, their sums over
/// rows, and those of the light that camera paths bring on their own, which are there twice for the pixels
/// that get more such paths.
std::uint64_t splat_bytes_per_pixel(const SceneCamera& camera) {
    const uint reach = splat_reach(camera, {});
    return reach == 0 ? 0
                      : splats_per_pixel(reach) * (sizeof(Splat) + 2 * sizeof(CameraSplat)) +
                            splat_rows(reach) * sizeof(RowSplat);
}

}  // namespace

MemoryEstimate estimate_memory(const Scene& scene) {
    constexpr std::uint64_t kTrianglesPerLeaf = 2;
    constexpr std::uint64_t kTrianglesPerCut = 20;  // one in so many is cut and is in two leaves
    const std::uint64_t triangles = scene.triangles.size();
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(scene.camera.width) * static_cast<std::uint64_t>(scene.camera.height);
    const std::uint64_t geometry = scene.vertices.size() * sizeof(Vertex) + triangles * sizeof(Triangle);
    const std::uint64_t entries = triangles + triangles / kTrianglesPerCut;
    const std::uint64_t trees =
        entries * (sizeof(BvhTriangle) + sizeof(uint)) + entries / kTrianglesPerLeaf * sizeof(BvhNode);
    const std::uint64_t textures = texture_bytes(scene);
    const std::uint64_t environment = scene.environment.radiance.size();
    constexpr std::uint64_t kReceiverBytes =
        (sizeof(ReceiverPacket) + 2 * sizeof(IrradiancePacket)) / NEARLIGHT_PACKET_SIZE +
        sizeof(CameraVertex);
    constexpr std::uint64_t kRefinementBytes = 2 * (sizeof(CameraLight) + sizeof(uint));
    constexpr std::uint64_t kPixelBytes =
        kReceiverBytes + kRefinementBytes +
        (NEARLIGHT_FILM_CHANNELS + NEARLIGHT_LAYER_CHANNELS) * sizeof(float);
    MemoryEstimate estimate;
    estimate.host = {{"geometry", geometry},
                     {"trees", trees},
                     {"textures", textures},
                     {"environment", environment * sizeof(Vec3)},
                     {"picture", pixels * NEARLIGHT_LAYER_CHANNELS * sizeof(float)}};
    // On the device, the environment has RGBA pixels and a table for sampling them.
    estimate.device = {{"geometry", geometry},
                       {"trees", trees},
                       {"textures", textures},
                       {"environment", environment * 5 * sizeof(float)},
                       {"picture", pixels * (kPixelBytes + splat_bytes_per_pixel(scene.camera))}};
    return estimate;
}

}  // namespace nearlight::core
