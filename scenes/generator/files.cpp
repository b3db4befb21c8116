// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/files.h"

#include <bit>
#include <cstring>
#include <fstream>

#include "nearlight/error.h"

namespace nearlight::core::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY files are written as the host stores numbers");

void write_file(const std::filesystem::path& file, const std::string& header, const std::string& body) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream << header << body;
    stream.close();
    if (!stream) {
        throw Error(ErrorKind::file,
                    "cannot write " + file.string() + ": check the folder and its free space");
    }
}

template <typename T>
void put(std::string& bytes, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

std::uint8_t to_byte(float value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

}  // namespace

Bitmap::Bitmap(int w, int h, Vec3 color) : width(w), height(h), pixels(static_cast<size_t>(w * h)) {
    fill(0, 0, w, h, color);
}

void Bitmap::set(int x, int y, Vec3 color) {
    if (x >= 0 && y >= 0 && x < width && y < height) {
        pixels[static_cast<size_t>(y * width + x)] = {to_byte(color.x), to_byte(color.y), to_byte(color.z)};
    }
}

void Bitmap::fill(int x, int y, int w, int h, Vec3 color) {
    for (int row = y; row < y + h; ++row) {
        for (int column = x; column < x + w; ++column) {
            set(column, row, color);
        }
    }
}

void write_ply(const std::filesystem::path& file, const Mesh& mesh) {
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment made by nearlight-scenes\n";
    header += "element vertex " + std::to_string(mesh.vertices.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"}) {
        header += std::string("property float ") + name + "\n";
    }
    header += "element face " + std::to_string(mesh.triangles.size()) + "\n";
    header += "property list uchar int vertex_indices\nend_header\n";
    std::string body;
    body.reserve(mesh.vertices.size() * 32 + mesh.triangles.size() * 13);
    for (const Vertex& vertex : mesh.vertices) {
        for (const float value : {vertex.position.x, vertex.position.y, vertex.position.z, vertex.normal.x,
                                  vertex.normal.y, vertex.normal.z, vertex.u, vertex.v}) {
            put(body, value);
        }
    }
    for (const auto& triangle : mesh.triangles) {
        put(body, std::uint8_t{3});
        for (const uint index : triangle) {
            put(body, static_cast<std::int32_t>(index));
        }
    }
    write_file(file, header, body);
}

void write_ppm(const std::filesystem::path& file, const Bitmap& bitmap) {
    std::string body;
    body.reserve(bitmap.pixels.size() * 3);
    for (const auto& pixel : bitmap.pixels) {
        for (const std::uint8_t value : pixel) {
            put(body, value);
        }
    }
    write_file(file, "P6\n" + std::to_string(bitmap.width) + " " + std::to_string(bitmap.height) + "\n255\n",
               body);
}

}  // namespace nearlight::core::scenes
