// SPDX-License-Identifier: Apache-2.0
#include "host/stages/device_scene.h"

#include <algorithm>

#include "host/scene/emitters.h"

namespace nearlight::core {
namespace {

/// The texels of all images one after the other, and the textures that say where each image begins.
struct TexturePool {
    std::vector<Texture> textures;
    std::vector<uint> texels;
};

TexturePool pool_textures(const Scene& scene) {
    TexturePool pool;
    std::vector<uint> first_texels;
    for (const TextureImage& image : scene.images) {
        first_texels.push_back(static_cast<uint>(pool.texels.size()));
        pool.texels.insert(pool.texels.end(), image.texels.begin(), image.texels.end());
    }
    for (const SceneTexture& texture : scene.textures) {
        Texture pooled = texture.parameters;
        if (pooled.kind == NEARLIGHT_TEXTURE_BITMAP) {
            const auto image = static_cast<std::size_t>(texture.image);
            pooled.first_texel = first_texels[image];
            pooled.width = static_cast<uint>(scene.images[image].width);
            pooled.height = static_cast<uint>(scene.images[image].height);
        }
        pool.textures.push_back(pooled);
    }
    return pool;
}

/// Averages the albedo over the centroids of a sample of triangles. That is good enough for the length of
/// light walks, which is all that it steers.
float estimate_mean_albedo(const Scene& scene) {
    const std::size_t stride = std::max<std::size_t>(1, scene.triangles.size() / 65536);
    double weighted = 0;
    double total = 0;
    for (std::size_t i = 0; i < scene.triangles.size(); i += stride) {
        const Triangle& triangle = scene.triangles[i];
        const Material& material = scene.materials[triangle.material];
        if (is_glass(material)) {
            continue;
        }
        const Vertex& a = scene.vertices[triangle.v0];
        const Vertex& b = scene.vertices[triangle.v1];
        const Vertex& c = scene.vertices[triangle.v2];
        const double area = triangle_area(scene, triangle);
        weighted +=
            area * luminance(light_albedo(scene, material, (a.u + b.u + c.u) / 3, (a.v + b.v + c.v) / 3));
        total += area;
    }
    return total > 0 ? static_cast<float>(weighted / total) : 0.5f;
}

bool divides_camera_paths(const Material& material) {
    return material.lobe == NEARLIGHT_LOBE_COAT || material.lobe == NEARLIGHT_LOBE_DIELECTRIC ||
           material.lobe == NEARLIGHT_LOBE_THIN_DIELECTRIC;
}

/// Uploads everything but the trees.
DeviceScene upload_surfaces_and_lights(Device& device, const Scene& scene, bool has_glass) {
    const EmitterTable emitters = build_emitter_table(scene);
    const EnvironmentTable environment = build_environment_table(scene);
    const TexturePool pool = pool_textures(scene);
    const Vec3 size = bounds(scene).size();

    DeviceScene on_device;
    on_device.host_info = {.triangle_count = static_cast<uint>(scene.triangles.size()),
                           .emitter_count = static_cast<uint>(emitters.emitters.size()),
                           .delta_emitter_count = emitters.delta_emitter_count,
                           .has_glass = has_glass ? 1u : 0u,
                           .extent = max_component(size),
                           .light_node_count = static_cast<uint>(emitters.light_tree.size()),
                           .pad0 = 0,
                           .pad1 = 0};
    on_device.has_lobes = std::any_of(scene.materials.begin(), scene.materials.end(), divides_camera_paths);
    on_device.mean_albedo = estimate_mean_albedo(scene);
    on_device.total_power = emitters.total_power;
    for (const Triangle& triangle : scene.triangles) {
        on_device.total_area += triangle_area(scene, triangle);
    }

    const auto put = [&]<typename T>(const std::vector<T>& values) {
        return Buffer<T>(device, std::span<const T>(values));
    };
    on_device.vertices = put(scene.vertices);
    on_device.triangles = put(scene.triangles);
    on_device.materials = put(scene.materials);
    on_device.textures = put(pool.textures);
    on_device.texels = put(pool.texels);
    on_device.emitters = put(emitters.emitters);
    on_device.environment = put(std::vector{environment.parameters});
    on_device.environment_pixels = put(environment.pixels);
    on_device.row_cdf = put(environment.row_cdf);
    on_device.column_cdf = put(environment.column_cdf);
    on_device.light_nodes = put(emitters.light_tree);
    on_device.info = put(std::vector{on_device.host_info});
    return on_device;
}

}  // namespace

DeviceScene upload_scene(Device& device, const Scene& scene, const SceneTrees& trees, GatherKernel kernel) {
    DeviceScene on_device = upload_surfaces_and_lights(device, scene, trees.has_glass);
    on_device.tree = upload(device, trees.opaque, tree_shapes(device, kernel));
    on_device.glass = upload(device, trees.glass, ray_tree_shapes(device));
    return on_device;
}

DeviceScene upload_scene(Device& device, const Scene& scene, const SceneBvhs& bvhs, GatherKernel kernel) {
    DeviceScene on_device = upload_surfaces_and_lights(device, scene, bvhs.has_glass);
    on_device.tree = upload_tree(device, bvhs.opaque, kernel);
    on_device.glass = upload_ray_tree(device, bvhs.glass);
    return on_device;
}

}  // namespace nearlight::core
