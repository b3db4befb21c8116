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

/// Something that the loader could not represent exactly, or that the user should know.
struct Note {
    std::filesystem::path file;
    int line = 0;  ///< counted from 1; 0 if not known
    std::string text;
};
/// The note as "file:line: text".
std::string to_string(const Note& note);

/// RGBA texels of 8 bits a channel, sRGB-encoded, top row first. Data that is linear in its file is encoded
/// by the loader, so that kernels know one encoding only.
struct TextureImage {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> texels;  ///< width·height; red in the lowest byte
};

/// A texture as materials refer to it: a placement of a bitmap, or a checkerboard.
struct SceneTexture {
    Texture parameters{};  ///< first_texel, width and height are filled in when images are pooled
    int image = -1;        ///< index into Scene::images, for NEARLIGHT_TEXTURE_BITMAP
};

/// Light from all directions, as a latitude-longitude map; 1 × 1 pixel if it is constant. The centre of pixel
/// (column i, row j) shines from the local direction (sin φ·sin θ, cos θ, −cos φ·sin θ) with φ = 2π·(i +
/// 0.5)/width and θ = π·(j + 0.5)/height, as in Mitsuba's `envmap`; radiance is constant over a pixel.
struct EnvironmentLight {
    int width = 0;  ///< 0 if there is no environment
    int height = 0;
    std::vector<Vec3> radiance;  ///< width·height, top row (+Y) first
    Mat4 to_world;               ///< rotation only
    /// A sun in front of the map: a disc of even radiance. The angle is 0 if there is none.
    Vec3 sun_direction{0, 0, 1};  ///< in the world, towards the sun
    float sun_half_angle = 0.0f;  ///< radians
    Vec3 sun_radiance{0, 0, 0};
};

struct SceneCamera {
    Mat4 to_world;  ///< looks along +Z, +Y up, +X to the left of the picture (Mitsuba's convention)
    double fov_x_degrees = 40.0;
    int width = 640;
    int height = 480;
};

struct Scene {
    std::string name;              ///< name of the folder or file
    std::filesystem::path source;  ///< the file that was asked for
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;  ///< no NaN, no index out of range; zero area is allowed
    std::vector<Material> materials;
    std::vector<SceneTexture> textures;
    std::vector<TextureImage> images;
    std::vector<Emitter> delta_emitters;  ///< probabilities are filled in later
    EnvironmentLight environment;
    SceneCamera camera;
    int max_depth = 0;          ///< Mitsuba's count (2: direct light only); 0: the file does not say
    int samples_per_pixel = 0;  ///< 0: the file does not say
    std::vector<Note> notes;    ///< approximations and oddities
};

/// The box of all vertices that triangles use.
Aabb bounds(const Scene& scene);
/// The area of a triangle, m².
float triangle_area(const Scene& scene, const Triangle& triangle);
/// A hash of everything that shapes the picture; equal scenes have equal hashes on all little-endian
/// machines.
std::uint64_t scene_hash(const Scene& scene);

/// Whether the material is glass, which only camera paths see.
bool is_glass(const Material& material);
/// The reflectance that light transport sees at texture coordinates (u, v); see Material.
Vec3 light_albedo(const Scene& scene, const Material& material, float u, float v);
/// The Lambertian reflectance that the camera sees at (u, v), without the coat's Fresnel factor; see
/// Material.
Vec3 camera_albedo(const Scene& scene, const Material& material, float u, float v);

}  // namespace nearlight::core
