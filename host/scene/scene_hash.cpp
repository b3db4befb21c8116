// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "host/base/hash.h"
#include "host/scene/scene.h"

namespace nearlight::core {
namespace {

// The bytes of numbers are hashed as they lie in memory.
static_assert(std::endian::native == std::endian::little, "scene hashes assume little-endian numbers");

/// The texture without padding and what is filled in later.
Texture essence(Texture texture) {
    texture.first_texel = texture.width = texture.height = 0;
    texture.pad0 = texture.pad1 = texture.pad2 = texture.pad3 = 0;
    return texture;
}

Emitter essence(Emitter emitter) {
    emitter.triangle = 0;
    emitter.tree_way = 0;
    emitter.probability = emitter.cdf = 0;
    return emitter;
}

void add_textures(Hasher& hasher, const Scene& scene) {
    hasher.add(static_cast<std::uint64_t>(scene.textures.size()));
    for (const SceneTexture& texture : scene.textures) {
        hasher.add(essence(texture.parameters));
        hasher.add(texture.image);
    }
    hasher.add(static_cast<std::uint64_t>(scene.images.size()));
    for (const TextureImage& image : scene.images) {
        hasher.add(image.width);
        hasher.add(image.height);
        hasher.add_array(image.texels);
    }
}

void add_lights(Hasher& hasher, const Scene& scene) {
    hasher.add(static_cast<std::uint64_t>(scene.delta_emitters.size()));
    for (const Emitter& emitter : scene.delta_emitters) {
        hasher.add(essence(emitter));
    }
    hasher.add(scene.environment.width);
    hasher.add(scene.environment.height);
    hasher.add_array(scene.environment.radiance);
    hasher.add(scene.environment.to_world.m);
    if (scene.environment.sun_half_angle > 0.0f) {
        hasher.add(scene.environment.sun_direction);
        hasher.add(scene.environment.sun_half_angle);
        hasher.add(scene.environment.sun_radiance);
    }
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
    Hasher hasher;
    hasher.add_array(scene.vertices);
    hasher.add_array(scene.triangles);
    hasher.add_array(scene.materials);
    add_textures(hasher, scene);
    add_lights(hasher, scene);
    hasher.add(scene.camera.to_world.m);
    hasher.add(scene.camera.fov_x_degrees);
    hasher.add(scene.camera.width);
    hasher.add(scene.camera.height);
    hasher.add(scene.max_depth);
    hasher.add(scene.samples_per_pixel);
    return hasher.hash64();
}

}  // namespace nearlight::core
