// SPDX-License-Identifier: Apache-2.0
// A scene as plain arrays: what every loader makes and everything else reads. World space in metres
// (or whatever unit the file has), linear sRGB colours.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/base/math.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Something that the loader could not take over exactly, said once.
struct Note {
    std::filesystem::path file;
    int line = 0;  ///< 1 is the first; 0: not known
    std::string text;
};
/// "file:line: text"
std::string to_string(const Note& note);

/// RGBA, 8 bits, sRGB-encoded, top row first. Data that is linear in its file is encoded by the loader, so
/// that kernels know one encoding only.
struct TextureImage {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> texels;  ///< width·height; red in the lowest byte
};

/// A texture as materials refer to it: a placement of a bitmap (index into Scene::images), or a checkerboard.
struct SceneTexture {
    Texture parameters{};  ///< first_texel, width and height are filled in when images are pooled
    int image = -1;        ///< for NEARLIGHT_TEXTURE_BITMAP
};

/// Latitude-longitude light from everywhere; 1 × 1 pixel for a constant one. The centre of pixel (column i,
/// row j) shines from the local direction (sin φ·sin θ, cos θ, −cos φ·sin θ) with φ = 2π·(i + 0.5)/width and
/// θ = π·(j + 0.5)/height, as Mitsuba's `envmap` has it; radiance is constant over a pixel.
struct EnvironmentLight {
    int width = 0;  ///< 0: none
    int height = 0;
    std::vector<Vec3> radiance;  ///< width·height, top row (+Y) first
    Mat4 to_world;               ///< rotation only
};

struct SceneCamera {
    Mat4 to_world;  ///< looks along +Z, +Y up, +X to the left of the picture (Mitsuba's convention)
    double fov_x_degrees = 40.0;
    int width = 640;
    int height = 480;
};

struct Scene {
    std::string name;              ///< of the folder or file
    std::filesystem::path source;  ///< the file that was asked for
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;  ///< no NaN, no index out of range; zero area is allowed
    std::vector<Material> materials;
    std::vector<SceneTexture> textures;
    std::vector<TextureImage> images;
    std::vector<Emitter> delta_emitters;  ///< point and spot lights; probabilities are filled in later
    EnvironmentLight environment;
    SceneCamera camera;
    int max_depth = 0;          ///< as Mitsuba counts (2: direct light only); 0: the file does not say
    int samples_per_pixel = 0;  ///< 0: the file does not say
    std::vector<Note> notes;    ///< approximations and oddities
};

/// Over all vertices that triangles use.
Aabb bounds(const Scene& scene);
/// Half the length of the cross product of two edges, m².
float triangle_area(const Scene& scene, const Triangle& triangle);
/// 64-bit FNV-1a over everything that shapes the picture; equal scenes have equal hashes on any machine.
std::uint64_t scene_hash(const Scene& scene);

/// True for glass, which only camera paths see.
bool is_glass(const Material& material);
/// Reflectance that light transport sees at texture coordinates (u, v); see Material.
Vec3 light_albedo(const Scene& scene, const Material& material, float u, float v);
/// Lambertian reflectance that the camera sees, without the coat's Fresnel factor; see Material.
Vec3 camera_albedo(const Scene& scene, const Material& material, float u, float v);

}  // namespace nearlight::core
