// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <span>
#include <type_traits>

#include "host/scene/scene.h"

namespace nearlight::core {
namespace {

// The bytes of numbers are hashed as they lie in memory.
static_assert(std::endian::native == std::endian::little, "scene hashes assume little-endian numbers");

/// 64-bit FNV-1a [Fowler, Noll, Vo].
class Hasher {
  public:
    template <typename T>
    void add(const T& value) {
        add_all(std::span(&value, 1));
    }
    /// With its length, so that what leaves one array cannot hide in the next.
    template <typename T>
    void add_array(const std::vector<T>& values) {
        add(static_cast<std::uint64_t>(values.size()));
        add_all(std::span(values));
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

  private:
    template <typename T, std::size_t extent>
    void add_all(std::span<T, extent> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        for (const std::byte byte : std::as_bytes(values)) {
            hash_ = (hash_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3ull;
        }
    }

    std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

/// Without what is padding or filled in later.
Texture essence(Texture texture) {
    texture.first_texel = texture.width = texture.height = 0;
    texture.pad0 = texture.pad1 = texture.pad2 = texture.pad3 = 0;
    return texture;
}

Emitter essence(Emitter emitter) {
    emitter.triangle = 0;
    emitter.area = emitter.probability = emitter.cdf = 0;
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
    return hasher.value();
}

}  // namespace nearlight::core
