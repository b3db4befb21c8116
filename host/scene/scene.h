// SPDX-License-Identifier: Apache-2.0
// A scene as plain arrays: what every loader makes and everything else reads. World space in metres
// (or whatever unit the file has), linear sRGB colours.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/base/math.h"
#include "host/scene/pixel_filter.h"
#include "kernels/shared/light.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// The maximum length of light paths where a file sets no limit, in Mitsuba's count. Less than a hundredth of
/// the light is left after so many surfaces, even within a diamond.
inline constexpr int kUnlimitedPathDepth = 256;

/// Something that the loader could not represent exactly, or that the user should know.
struct Note {
    std::filesystem::path file;
    int line = 0;  ///< counted from 1; 0 if not known
    std::string text;
};
/// The note as "file:line: text".
std::string to_string(const Note& note);

/// The texels of a bitmap, top row first, in one of the NEARLIGHT_TEXELS_ formats.
struct TextureImage {
    std::string name;
    int width = 0;
    int height = 0;
    uint format = NEARLIGHT_TEXELS_SRGB8;
    std::vector<std::uint32_t> words;  ///< width·height, or twice as many half floats
};

/// A texture as materials refer to it: a placement of a bitmap, a checkerboard, or the vertices' colours.
struct SceneTexture {
    Texture parameters{};  ///< first_word, width, height and format are filled in when images are pooled
    int image = -1;        ///< index into Scene::images, for NEARLIGHT_TEXTURE_BITMAP
};

/// A sphere or open cylinder of even radiance that shines outwards, for which triangles of the scene stand.
/// It is one light.
struct RoundLamp {
    Vec3 center{0, 0, 0};       ///< of the sphere, or of one end of the cylinder
    Vec3 axis{0, 0, 0};         ///< of the cylinder, from that end to the other; zero for a sphere
    float radius = 0.0f;        ///< m
    float outer_radius = 0.0f;  ///< all its triangles lie within this distance of the centre or axis, m
    uint first_triangle = 0;    ///< index into Scene::triangles
    uint triangle_count = 0;
};

/// Light from all directions, as a latitude-longitude map; 1 × 1 pixel if it is constant. The centre of pixel
/// (column i, row j) shines from the local direction (sin φ·sin θ, cos θ, −cos φ·sin θ) with φ = 2π·(i +
/// 0.5)/width and θ = π·(j + 0.5)/height, and radiance is constant over a pixel, unless it is interpolated.
struct EnvironmentLight {
    int width = 0;  ///< 0 if there is no environment
    int height = 0;
    std::vector<Vec3> radiance;  ///< width·height, top row (+Y) first
    Mat4 to_world;               ///< rotation only
    /// Whether radiance is interpolated between pixels, as in Mitsuba's `envmap`: columns have their centres
    /// at (i + 0.5)/width, and rows lie at θ = π·j/(height − 1).
    bool is_interpolated = false;
    /// A sun in front of the map: a disc of even radiance. The angle is 0 if there is none.
    Vec3 sun_direction{0, 0, 1};  ///< in the world, towards the sun
    float sun_half_angle = 0.0f;  ///< radians
    Vec3 sun_radiance{0, 0, 0};
};

/// A run of triangles that belong to one object; it ends where the next one begins.
struct ObjectRun {
    uint first_triangle = 0;
    uint name = 0;  ///< index into the names of objects
};

enum class CameraKind { perspective, orthographic };

/// The camera, with what its film and the integrator say about what it shows.
struct SceneCamera {
    Mat4 to_world;  ///< looks along +Z, +Y up, +X to the left of the picture (Mitsuba's convention)
    CameraKind kind = CameraKind::perspective;
    double fov_x_degrees = 40.0;  ///< of the whole film; an orthographic film is 2 wide in local units
    int width = 640;              ///< pixels of the picture, which may be a part of the film
    int height = 480;
    double center_x = 0.0;   ///< the picture's middle on the film, from the axis to the right, in film widths
    double center_y = 0.0;   ///< downwards, in film widths as well
    double film_part = 1.0;  ///< width of the picture / width of the film
    double aperture_radius = 0.0;  ///< of a thin lens; 0: a pinhole
    double focus_distance = 1.0;   ///< along +Z, for a thin lens
    double near_clip = 0.0;        ///< surfaces are seen between these distances along +Z
    double far_clip = std::numeric_limits<double>::infinity();
    PixelFilter filter{};
    /// Pixels at the border take light from beyond it, as far as the filter goes.
    bool sample_border = false;
    bool hide_emitters = false;  ///< emitters and the environment are not seen directly
    bool is_monochrome = false;  ///< the picture has the luminance of its light in all channels
};

/// Seconds of a file's animations.
struct TimeSpan {
    double begin = 0;
    double end = 0;
};

/// An animation that a file has, whether or not it is played.
struct SceneAnimation {
    /// A property of a node: "translation", "rotation", "scale" or "weights".
    struct Motion {
        std::string node;
        std::string property;
    };
    std::string name{};              ///< empty if it has none
    std::optional<TimeSpan> span{};  ///< from its first to its last key; empty if it moves nothing
    std::vector<Motion> motions{};
    std::string fault{};  ///< why it cannot be played; empty if it can be
};

struct Scene {
    std::string name;              ///< name of the folder or file
    std::filesystem::path source;  ///< the file that was asked for
    std::vector<Vertex> vertices;
    std::vector<Vec3> vertex_colors;  ///< linear sRGB, one a vertex; empty if no texture asks for them
    /// Texture coordinates of textures with NEARLIGHT_TEXTURE_SECOND_UV, one a vertex; empty if there are
    /// none.
    std::vector<std::array<float, 2>> second_uvs;
    std::vector<Triangle> triangles;  ///< no NaN, no index out of range; zero area is allowed
    std::vector<Material> materials;  ///< children may stand before or after those that name them
    // The names that the file has for its objects and materials; several may have the same one.
    std::vector<std::string> object_names;
    std::vector<ObjectRun> objects;  ///< in the order of triangles; those before the first have no name
    std::vector<std::string> material_names;  ///< one a material; empty or missing: it has no name
    /// Rows of NEARLIGHT_CURVE_SIZE values, see Material::curve; row 0 is all ones.
    std::vector<float> transmission_curves = std::vector<float>(NEARLIGHT_CURVE_SIZE, 1.0f);
    std::vector<SceneTexture> textures;
    std::vector<TextureImage> images;
    std::vector<Emitter> delta_emitters;  ///< probabilities are filled in later
    std::vector<RoundLamp> round_lamps;   ///< in the order of their triangles
    EnvironmentLight environment;
    SceneCamera camera;
    /// Light that was scattered passes smooth glass bodies straight, and veils let the light of delta lights
    /// pass too (docs/method.md, "Clear glass").
    bool clear_glass = false;
    /// Thin panes, masks and `null` let the light of delta lights pass straight, as glTF, OBJ and PLY mean
    /// them; in Mitsuba they block it.
    bool open_veils = false;
    int max_depth = kUnlimitedPathDepth;  ///< Mitsuba's count (2: direct light only)
    int samples_per_pixel = 0;            ///< 0: the file does not say
    /// The file's light has no scale of its own, so that pictures for screens choose their exposure.
    bool has_open_exposure = false;
    /// From the first to the last key of the animations that are played; empty if the scene is at rest.
    std::optional<TimeSpan> animation{};
    std::vector<SceneAnimation> animations;  ///< of the file, if LoadOptions::lists_animations asked for them
    /// Tells scenes that one animated file is at several moments: those with equal poses differ in their
    /// camera only.
    std::uint64_t pose = 0;
    std::vector<Note> notes;  ///< approximations and oddities
};

/// How many triangles a tree can hold.
inline constexpr std::size_t kMaxSceneTriangles = NEARLIGHT_LEAF_FIRST_MASK;
/// Throws Error(ErrorKind::out_of_memory) if that is less than `count`.
void check_triangle_count(std::size_t count);

/// The box of all vertices that triangles use.
Aabb bounds(const Scene& scene);

struct Sphere {
    Vec3 center{0, 0, 0};
    float radius = 0;
};

/// The sphere about the centre of that box through the farthest vertex that a triangle uses.
Sphere bounding_sphere(const Scene& scene);
/// Whether a triangle shines.
bool has_emitting_surface(const Scene& scene);
/// Whether anything shines. Surfaces count only if `surfaces_are_lamps` is set.
bool has_light(const Scene& scene, bool surfaces_are_lamps = true);
/// The area of a triangle, m².
float triangle_area(const Scene& scene, const Triangle& triangle);
/// A hash of everything that shapes the picture; equal scenes have equal hashes on all little-endian
/// machines.
std::uint64_t scene_hash(const Scene& scene);
/// A hash of what shapes the light, whoever looks: of all that scene_hash() takes but the camera and the
/// limits of depth and samples.
std::uint64_t lighting_hash(const Scene& scene);

}  // namespace nearlight::core
