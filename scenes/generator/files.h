// SPDX-License-Identifier: Apache-2.0
// Writes the generator's files: meshes as binary PLY, bitmaps as binary PPM.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// An sRGB-encoded picture, top row first.
struct Bitmap {
    int width = 0;
    int height = 0;
    std::vector<std::array<std::uint8_t, 3>> pixels;

    Bitmap() = default;
    Bitmap(int w, int h, Vec3 color);
    /// Sets a pixel. Colour components are in [0, 1]; places outside the picture are ignored.
    void set(int x, int y, Vec3 color);
    void fill(int x, int y, int w, int h, Vec3 color);
};

/// Writes a mesh in little-endian order, with 32-bit floats for position, normal and texture coordinates u,
/// v. The top row of a bitmap is at v = 0. Throws Error(ErrorKind::file).
void write_ply(const std::filesystem::path& file, const Mesh& mesh);
/// Writes a bitmap. Throws Error(ErrorKind::file).
void write_ppm(const std::filesystem::path& file, const Bitmap& bitmap);

}  // namespace nearlight::core::scenes
