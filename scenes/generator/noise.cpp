// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/noise.h"

#include <cstdint>

namespace nearlight::core::scenes {
namespace {

float lattice_value(int x, int y, int z) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u +
                      static_cast<std::uint32_t>(y) * 0xd8163841u +
                      static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
    h ^= h >> 16u;
    h *= 0x7feb352du;
    h ^= h >> 15u;
    h *= 0x846ca68bu;
    h ^= h >> 16u;
    return static_cast<float>(h >> 8u) * 0x1p-23f - 1.0f;
}

float ease(float t) {
    return t * t * (3.0f - 2.0f * t);
}

float mix(float a, float b, float t) {
    return a + (b - a) * t;
}

}  // namespace

float value_noise(Vec3 p) {
    const Vec3 floor{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const int x = static_cast<int>(floor.x), y = static_cast<int>(floor.y), z = static_cast<int>(floor.z);
    const Vec3 t{ease(p.x - floor.x), ease(p.y - floor.y), ease(p.z - floor.z)};
    const auto row = [&](int dy, int dz) {
        return mix(lattice_value(x, y + dy, z + dz), lattice_value(x + 1, y + dy, z + dz), t.x);
    };
    return mix(mix(row(0, 0), row(1, 0), t.y), mix(row(0, 1), row(1, 1), t.y), t.z);
}

float fractal_noise(Vec3 p, int octaves) {
    float sum = 0.0f, amplitude = 0.5f;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * value_noise(p);
        p = p * 2.0f + Vec3{17.3f, 5.1f, 9.7f};
        amplitude *= 0.5f;
    }
    return sum;
}

}  // namespace nearlight::core::scenes
