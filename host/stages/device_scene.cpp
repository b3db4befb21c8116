// SPDX-License-Identifier: Apache-2.0
#include "host/stages/device_scene.h"

#include <algorithm>
#include <cmath>

#include "host/scene/emitters.h"
#include "host/scene/environment_table.h"
#include "host/scene/reflectance.h"
#include "host/stages/runs.h"

namespace nearlight::core {
namespace {

/// The words of all images one after the other. Each image is copied by itself, because all of them may be
/// most of what the machine has memory for.
Buffer<uint> pool_of_words(Device& device, const Scene& scene) {
    std::size_t count = 0;
    for (const TextureImage& image : scene.images) {
        count += image.words.size();
    }
    to_kernel_count(count, "words of textures");
    Buffer<uint> words(device, count);
    std::size_t first = 0;
    for (const TextureImage& image : scene.images) {
        words.upload(image.words, first);
        first += image.words.size();
    }
    return words;
}

/// The textures, with the places of their images in the pool of words.
std::vector<Texture> pooled_textures(const Scene& scene) {
    std::vector<uint> first_words;
    uint first = 0;
    for (const TextureImage& image : scene.images) {
        first_words.push_back(first);
        first += static_cast<uint>(image.words.size());
    }
    std::vector<Texture> textures;
    for (const SceneTexture& texture : scene.textures) {
        Texture pooled = texture.parameters;
        if (pooled.kind == NEARLIGHT_TEXTURE_BITMAP) {
            const auto image = static_cast<std::size_t>(texture.image);
            pooled.first_word = first_words[image];
            pooled.width = static_cast<uint>(scene.images[image].width);
            pooled.height = static_cast<uint>(scene.images[image].height);
            pooled.format = scene.images[image].format;
        }
        textures.push_back(pooled);
    }
    return textures;
}

/// Averages what surfaces reflect or let through over triangles that lie equal areas apart. That is good
/// enough for the length of light walks, which is all that it steers.
float estimate_mean_albedo(const Scene& scene, double total_area) {
    constexpr int kSamples = 1024;
    const double step = total_area / kSamples;
    double passed = 0;
    double next = 0.5 * step;
    double sum = 0;
    for (const Triangle& triangle : scene.triangles) {
        passed += triangle_area(scene, triangle);
        if (!(next < passed)) {
            continue;
        }
        const Vertex& a = scene.vertices[triangle.v0];
        const Vertex& b = scene.vertices[triangle.v1];
        const Vertex& c = scene.vertices[triangle.v2];
        const double count = std::floor((passed - next) / step) + 1;
        sum += count * luminance(mean_reflectance(scene, scene.materials[triangle.material],
                                                  (a.u + b.u + c.u) / 3, (a.v + b.v + c.v) / 3));
        next += count * step;
    }
    return total_area > 0 ? static_cast<float>(sum / kSamples) : 0.5f;
}

/// The flags that say which sides of a material have a Lambertian part.
uint diffuse_sides(const Scene& scene, const Material& material) {
    const auto of_child = [&](uint i) { return diffuse_sides(scene, scene.materials[material.child[i]]); };
    switch (material.model) {
        case NEARLIGHT_BSDF_TWO_SIDED: {
            const uint back = of_child(1) & NEARLIGHT_MATERIAL_DIFFUSE_FRONT;
            return (of_child(0) & NEARLIGHT_MATERIAL_DIFFUSE_FRONT) |
                   (back != 0 ? NEARLIGHT_MATERIAL_DIFFUSE_BACK : 0u);
        }
        case NEARLIGHT_BSDF_BLEND:
            return of_child(0) | of_child(1);
        case NEARLIGHT_BSDF_MASK:
        case NEARLIGHT_BSDF_NORMAL_MAP:
        case NEARLIGHT_BSDF_BUMP_MAP:
            return of_child(0);
        default:
            break;
    }
    if (!has_diffuse(scene, material)) {
        return 0;
    }
    const bool both = (material.flags & NEARLIGHT_MATERIAL_THIN) != 0;
    return NEARLIGHT_MATERIAL_DIFFUSE_FRONT | (both ? NEARLIGHT_MATERIAL_DIFFUSE_BACK : 0u);
}

/// The materials with the flags that only kernels ask for.
std::vector<Material> device_materials(const Scene& scene) {
    std::vector<Material> materials = scene.materials;
    for (Material& material : materials) {
        material.flags |= diffuse_sides(scene, material);
        material.flags |= is_veil(scene, material) ? NEARLIGHT_MATERIAL_VEIL : 0u;
    }
    return materials;
}

/// Whether camera paths have two ways on from some surface: D and S, or reflection and what is let through.
bool has_two_ways(const Scene& scene, const Material& material) {
    return has_specular(scene, material) && (has_diffuse(scene, material) || lets_through(scene, material));
}

bool is_map(const Material& material) {
    return material.model == NEARLIGHT_BSDF_NORMAL_MAP || material.model == NEARLIGHT_BSDF_BUMP_MAP;
}

SceneInfo describe(const Scene& scene, const EmitterTable& emitters) {
    const Vec3 size = bounds(scene).size();
    return {.triangle_count = static_cast<uint>(scene.triangles.size()),
            .emitter_count = static_cast<uint>(emitters.emitters.size()),
            .delta_emitter_count = emitters.delta_emitter_count,
            .extent = max_component(size),
            .size = size,
            .has_specular = std::ranges::any_of(
                scene.materials, [&](const Material& material) { return has_specular(scene, material); }),
            .has_curves = scene.transmission_curves.size() > NEARLIGHT_CURVE_SIZE ? 1u : 0u,
            .tree_first = emitters.tree_first,
            .tree_end = emitters.tree_end,
            .has_maps = std::ranges::any_of(scene.materials, is_map),
            .veils = veils_of(scene),
            .has_sky = std::ranges::any_of(emitters.emitters, is_distant)};
}

/// Uploads everything but the tree.
DeviceScene upload_surfaces_and_lights(Device& device, const Scene& scene) {
    const EmitterTable emitters = build_emitter_table(scene);
    const EnvironmentTable environment = build_environment_table(scene);

    DeviceScene on_device;
    on_device.host_info = describe(scene, emitters);
    on_device.divides_paths = std::ranges::any_of(
        scene.materials, [&](const Material& material) { return has_two_ways(scene, material); });
    on_device.has_rough_gloss = std::ranges::any_of(
        scene.materials, [&](const Material& material) { return has_rough_gloss(scene, material); });
    on_device.has_mirrors = std::ranges::any_of(
        scene.materials, [&](const Material& material) { return has_mirror(scene, material); });
    on_device.total_power = emitters.total_power;
    for (const Triangle& triangle : scene.triangles) {
        on_device.total_area += triangle_area(scene, triangle);
    }
    on_device.mean_albedo = estimate_mean_albedo(scene, on_device.total_area);

    const auto put = [&]<typename T>(const std::vector<T>& values) {
        return Buffer<T>(device, std::span<const T>(values));
    };
    on_device.vertices = put(scene.vertices);
    on_device.triangles = put(scene.triangles);
    on_device.materials = put(device_materials(scene));
    on_device.textures = put(pooled_textures(scene));
    on_device.texels = pool_of_words(device, scene);
    on_device.vertex_colors = put(scene.vertex_colors);
    on_device.second_uvs = put(scene.second_uvs);
    on_device.curves = put(scene.transmission_curves);
    on_device.emitters = put(emitters.emitters);
    on_device.environment = put(std::vector{environment.parameters});
    on_device.environment_pixels = put(environment.pixels);
    on_device.row_cdf = put(environment.row_cdf);
    on_device.column_cdf = put(environment.column_cdf);
    on_device.row_cosines = put(environment.row_cosines);
    on_device.block_details = put(environment.block_details);
    on_device.detail_cdf = put(environment.detail_cdf);
    on_device.light_nodes = put(emitters.light_tree);
    on_device.info = put(std::vector{on_device.host_info});
    on_device.caustic_aims = CausticAims(device);
    return on_device;
}

}  // namespace

DeviceScene upload_scene(Device& device, const Scene& scene, const ShapedBvh& tree, GatherKernel kernel) {
    const TreeShapes shapes = tree_shapes(device, kernel);
    DeviceScene on_device = upload_surfaces_and_lights(device, scene);
    on_device.tree = upload(device, tree, shapes);
    if (on_device.has_veils()) {
        on_device.veil_trees = make_veil_trees(device, scene, tree, shapes);
    }
    return on_device;
}

DeviceScene upload_scene(Device& device, const Scene& scene, const Bvh& bvh, GatherKernel kernel) {
    const bool is_widened = tree_shapes(device, kernel).wide;
    return upload_scene(device, scene, {.binary = bvh, .wide = is_widened ? widen(bvh) : WideBvh{}}, kernel);
}

}  // namespace nearlight::core
