// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "host/base/hash.h"
#include "host/scene/reflectance.h"
#include "host/scene/scene.h"

namespace nearlight::core {
namespace {

// The bytes of numbers are hashed as they lie in memory.
static_assert(std::endian::native == std::endian::little, "scene hashes assume little-endian numbers");

/// The texture without what is filled in later.
Texture essence(Texture texture) {
    texture.first_word = texture.width = texture.height = texture.format = 0;
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
        hasher.add(image.format);
        hasher.add_array(image.words);
    }
}

void add_lights(Hasher& hasher, const Scene& scene) {
    hasher.add(static_cast<std::uint64_t>(scene.delta_emitters.size()));
    for (const Emitter& emitter : scene.delta_emitters) {
        hasher.add(essence(emitter));
    }
    for (const RoundLamp& lamp : scene.round_lamps) {
        hasher.add(lamp);
    }
    hasher.add(scene.environment.width);
    hasher.add(scene.environment.height);
    hasher.add_array(scene.environment.radiance);
    hasher.add(scene.environment.to_world.m);
    if (scene.environment.is_interpolated) {
        hasher.add(true);
    }
    if (scene.environment.sun_half_angle > 0.0f) {
        hasher.add(scene.environment.sun_direction);
        hasher.add(scene.environment.sun_half_angle);
        hasher.add(scene.environment.sun_radiance);
    }
}

void add_camera(Hasher& hasher, const SceneCamera& camera) {
    hasher.add(camera.to_world.m);
    hasher.add(camera.fov_x_degrees);
    hasher.add(camera.width);
    hasher.add(camera.height);
    hasher.add(static_cast<int>(camera.kind));
    for (const double number :
         {camera.center_x, camera.center_y, camera.film_part, camera.aperture_radius, camera.focus_distance,
          camera.near_clip, camera.far_clip, camera.filter.radius, camera.filter.b, camera.filter.c}) {
        hasher.add(number);
    }
    hasher.add(static_cast<int>(camera.filter.kind));
    for (const bool choice : {camera.sample_border, camera.hide_emitters, camera.is_monochrome}) {
        hasher.add(static_cast<int>(choice));
    }
}

void add_surfaces_and_lights(Hasher& hasher, const Scene& scene) {
    hasher.add_array(scene.vertices);
    hasher.add_array(scene.vertex_colors);
    hasher.add_array(scene.triangles);
    hasher.add_array(scene.materials);
    hasher.add_array(scene.transmission_curves);
    add_textures(hasher, scene);
    add_lights(hasher, scene);
}

/// Adds what only some scenes have, so that the hashes of others do not depend on it.
void add_extras(Hasher& hasher, const Scene& scene) {
    if (!scene.second_uvs.empty()) {
        hasher.add_array(scene.second_uvs);
    }
    if (scene.clear_glass) {
        hasher.add(true);
    }
    if (scene.open_veils && veils_of(scene) != NEARLIGHT_VEILS_NONE) {
        hasher.add(false);
    }
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
    Hasher hasher;
    add_surfaces_and_lights(hasher, scene);
    add_camera(hasher, scene.camera);
    hasher.add(scene.max_depth);
    hasher.add(scene.samples_per_pixel);
    add_extras(hasher, scene);
    return hasher.hash64();
}

std::uint64_t lighting_hash(const Scene& scene) {
    Hasher hasher;
    add_surfaces_and_lights(hasher, scene);
    add_extras(hasher, scene);
    return hasher.hash64();
}

}  // namespace nearlight::core
