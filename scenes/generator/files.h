// SPDX-License-Identifier: Apache-2.0
// What the generator writes: meshes as binary PLY, bitmaps as binary PPM.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// sRGB-encoded picture, top row first.
struct Bitmap {
    int width = 0;
    int height = 0;
    std::vector<std::array<std::uint8_t, 3>> pixels;

    Bitmap() = default;
    Bitmap(int w, int h, Vec3 color);
    /// Colour components in [0, 1]; places outside the picture are ignored.
    void set(int x, int y, Vec3 color);
    void fill(int x, int y, int w, int h, Vec3 color);
};

/// Little-endian, 32-bit floats: position, normal and texture coordinates u, v (v = 0 is a bitmap's top row).
void write_ply(const std::filesystem::path& file, const Mesh& mesh);
void write_ppm(const std::filesystem::path& file, const Bitmap& bitmap);

}  // namespace nearlight::core::scenes
