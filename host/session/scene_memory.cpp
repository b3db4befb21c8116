// SPDX-License-Identifier: Apache-2.0
#include "host/session/scene_memory.h"

#include <span>
#include <string>

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// Vertices have colours and second coordinates only if textures are looked up there.
std::uint64_t texture_bytes(const Scene& scene) {
    std::uint64_t sum =
        std::span(scene.vertex_colors).size_bytes() + std::span(scene.second_uvs).size_bytes();
    for (const TextureImage& image : scene.images) {
        sum += std::span(image.words).size_bytes();
    }
    return sum;
}

std::uint64_t tree_bytes(std::uint64_t triangles) {
    constexpr std::uint64_t kTrianglesPerLeaf = 2;
    constexpr std::uint64_t kTrianglesPerCut = 20;  // one in so many is cut and is in two leaves
    const std::uint64_t entries = triangles + triangles / kTrianglesPerCut;
    return entries * (sizeof(BvhTriangle) + sizeof(uint)) + entries / kTrianglesPerLeaf * sizeof(BvhNode);
}

std::string in_mib(std::uint64_t bytes) {
    return std::to_string(bytes >> 20) + " MiB";
}

}  // namespace

SceneMemory estimate_scene_memory(const Scene& scene) {
    const std::uint64_t triangles = scene.triangles.size();
    const std::uint64_t texels = scene.environment.radiance.size();
    // On a device, the environment has RGBA pixels and a table for sampling them.
    return {.geometry = scene.vertices.size() * sizeof(Vertex) + triangles * sizeof(Triangle),
            .trees = tree_bytes(triangles),
            .textures = texture_bytes(scene),
            .environment_on_host = texels * sizeof(Vec3),
            .environment_on_device = texels * 5 * sizeof(float)};
}

void check_scene_memory(const Scene& scene, std::size_t cpu_devices, std::uint64_t free_bytes) {
    const SceneMemory memory = estimate_scene_memory(scene);
    const std::uint64_t needed = memory.trees + cpu_devices * memory.on_device();
    if (needed > free_bytes) {
        throw Error(ErrorKind::out_of_memory, "the scene, with " + std::to_string(scene.triangles.size()) +
                                                  " triangles, needs about " + in_mib(needed) +
                                                  " more of memory, and " + in_mib(free_bytes) + " are free");
    }
}

}  // namespace nearlight::core
