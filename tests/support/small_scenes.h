// SPDX-License-Identifier: Apache-2.0
// Scenes of a few triangles, built in code, whose light is known.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "host/image/image.h"
#include "host/reference/synthetic_scene.h"
#include "host/scene/material_model.h"
#include "host/scene/mitsuba/round_lamp.h"
#include "host/scene/mitsuba/shape_mesh.h"
#include "host/scene/scene.h"
#include "host/scene/scene_loader.h"

namespace nearlight::core::small_scenes {

inline Material lambertian(Vec3 albedo) {
    return diffuse_material(albedo);
}

inline uint add_material(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return static_cast<uint>(scene.materials.size() - 1);
}

inline uint add_vertex(Scene& scene, Vec3 position) {
    scene.vertices.push_back({position, 0, {0, 0, 0}, 0});
    return static_cast<uint>(scene.vertices.size() - 1);
}

inline void add_triangle(Scene& scene, Vec3 a, Vec3 b, Vec3 c, uint material) {
    const uint first = add_vertex(scene, a);
    add_vertex(scene, b);
    add_vertex(scene, c);
    scene.triangles.push_back({first, first + 1, first + 2, material});
}

/// Adds the parallelogram corner, corner + s, corner + s + t, corner + t, whose front is on the side of s ×
/// t.
inline void add_quad(Scene& scene, Vec3 corner, Vec3 s, Vec3 t, uint material) {
    add_parallelogram(scene, corner, s, t, material);
}

/// A sphere about the origin of 20·4^subdivisions triangles whose fronts face the inside.
inline void add_inward_sphere(Scene& scene, float radius, int subdivisions, uint material) {
    const float g = 0.5f * (1.0f + std::sqrt(5.0f));
    const std::array<Vec3, 12> corners{Vec3{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                       {0, -1, g},     {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                       {g, 0, -1},     {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    constexpr std::array<std::array<int, 3>, 20> kFaces{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    std::vector<std::array<Vec3, 3>> faces;
    for (const auto& face : kFaces) {
        faces.push_back({normalize(corners[static_cast<std::size_t>(face[0])]),
                         normalize(corners[static_cast<std::size_t>(face[1])]),
                         normalize(corners[static_cast<std::size_t>(face[2])])});
    }
    for (int i = 0; i < subdivisions; ++i) {
        std::vector<std::array<Vec3, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const Vec3 ab = normalize(a + b);
            const Vec3 bc = normalize(b + c);
            const Vec3 ca = normalize(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    for (const auto& [a, b, c] : faces) {
        add_triangle(scene, a * radius, c * radius, b * radius, material);
    }
}

inline void set_constant_sky(Scene& scene, Vec3 radiance) {
    scene.environment = {.width = 1, .height = 1, .radiance = {radiance}, .to_world = {}};
}

inline Material coated(Scene& scene, Vec3 base, const Coat& coat) {
    Material material = plastic_material(scene, coat);
    material.reflectance = parameter_of(base);
    return material;
}

/// A shining shape of Mitsuba's, which is one light, with the triangles that stand for it.
inline void add_round_lamp(Scene& scene, const std::string& type, const Mat4& to_world, Vec3 radiance) {
    Material material = lambertian({0, 0, 0});
    material.emission = parameter_of(radiance);
    const uint index = add_material(scene, material);
    const Mesh mesh = type == "sphere" ? mitsuba::sphere_mesh() : mitsuba::cylinder_mesh();
    const std::size_t first_triangle = scene.triangles.size();
    const auto first = static_cast<uint>(scene.vertices.size());
    for (const Vec3 position : mesh.positions) {
        add_vertex(scene, transform_point(to_world, position));
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        scene.triangles.push_back({first + a, first + b, first + c, index});
    }
    scene.round_lamps.push_back(mitsuba::round_lamp(scene, type, to_world, first_triangle).value());
}

inline void add_sphere_lamp(Scene& scene, Vec3 center, float radius, Vec3 radiance) {
    add_round_lamp(scene, "sphere",
                   translation(center.x, center.y, center.z) * scaling(radius, radius, radius), radiance);
}

/// A cylinder about an axis that is turned by `degrees` from +Z towards −Y.
inline void add_cylinder_lamp(Scene& scene, Vec3 end, double degrees, float radius, float length,
                              Vec3 radiance) {
    add_round_lamp(
        scene, "cylinder",
        translation(end.x, end.y, end.z) * rotation(1, 0, 0, degrees) * scaling(radius, radius, length),
        radiance);
}

inline void add_point_light(Scene& scene, Vec3 position, Vec3 intensity) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_POINT;
    light.position = position;
    light.radiance = intensity;
    scene.delta_emitters.push_back(light);
}

/// Adds a projector of the texture with the index `texture` (−1: an even image), `half_width` wide and
/// `half_height` high at the distance 1, which sends `intensity` along its axis.
inline void add_projector(Scene& scene, Vec3 position, Vec3 axis, float half_width, float half_height,
                          Vec3 intensity, int texture) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_PROJECTOR;
    light.position = position;
    light.direction = normalize(axis);
    const auto [x, y] = orthonormal_basis(light.direction);
    light.x_axis = x * (0.5f / half_width);
    light.y_axis = y * (0.5f / half_height);
    light.area = 4.0f * half_width * half_height;
    light.radiance = intensity;
    light.image = static_cast<uint>(texture + 1);
    scene.delta_emitters.push_back(light);
}

inline void add_directional_light(Scene& scene, Vec3 direction, Vec3 irradiance) {
    Emitter light{};
    light.type = NEARLIGHT_EMITTER_DIRECTIONAL;
    light.direction = normalize(direction);
    light.radiance = irradiance;
    scene.delta_emitters.push_back(light);
}

/// Adds a bitmap of four texels, whose colours differ, and returns the texture's index.
inline int add_small_bitmap(Scene& scene) {
    scene.images.push_back(
        {"four", 2, 2, NEARLIGHT_TEXELS_SRGB8, {0xff0000ffu, 0xff00ff80u, 0xffff4020u, 0xff808080u}});
    SceneTexture bitmap;
    bitmap.parameters.kind = NEARLIGHT_TEXTURE_BITMAP;
    bitmap.parameters.u_scale = bitmap.parameters.v_scale = 1.0f;
    bitmap.image = static_cast<int>(scene.images.size()) - 1;
    scene.textures.push_back(bitmap);
    return static_cast<int>(scene.textures.size()) - 1;
}

inline void set_camera(Scene& scene, std::array<double, 3> origin, std::array<double, 3> target, double fov,
                       std::array<double, 3> up = {0, 1, 0}) {
    scene.camera.to_world = look_at(origin, target, up);
    scene.camera.fov_x_degrees = fov;
}

/// A checkerboard of `scale` periods to each unit of texture coordinates; returns its index.
inline int add_checkerboard(Scene& scene, float scale, const Parameter& color0, const Parameter& color1) {
    SceneTexture checkerboard;
    checkerboard.parameters.kind = NEARLIGHT_TEXTURE_CHECKERBOARD;
    checkerboard.parameters.u_scale = checkerboard.parameters.v_scale = scale;
    checkerboard.parameters.color0 = color0;
    checkerboard.parameters.color1 = color1;
    scene.textures.push_back(checkerboard);
    return static_cast<int>(scene.textures.size()) - 1;
}

/// A floor of two triangles, 40 × 40, with a checkerboard of cells of 0.5. A wall and a block stand on it,
/// under a point light. The camera sees a few square metres of it, so any close range cuts through both
/// triangles.
inline Scene checkered_plain() {
    Scene scene;
    Material tiles = lambertian({1, 1, 1});
    tiles.reflectance = textured(add_checkerboard(scene, 1, parameter_of(Vec3{0.8f, 0.7f, 0.6f}),
                                                  parameter_of(Vec3{0.1f, 0.15f, 0.3f})));
    add_quad(scene, {-20, 0, -20}, {0, 0, 40}, {40, 0, 0}, add_material(scene, tiles));
    for (Vertex& vertex : scene.vertices) {
        vertex.u = vertex.position.x;  // a period of the pattern is two cells
        vertex.v = vertex.position.z;
    }
    const uint plaster = add_material(scene, lambertian({0.7f, 0.7f, 0.7f}));
    const uint brick = add_material(scene, lambertian({0.6f, 0.25f, 0.15f}));
    add_quad(scene, {-2, 0, 2}, {0, 1.5f, 0}, {4, 0, 0}, plaster);  // the wall, facing the camera
    add_quad(scene, {0.3f, 0, 0.6f}, {0, 0.6f, 0}, {0.6f, 0, 0.2f}, brick);
    add_quad(scene, {0.3f, 0, 0.6f}, {-0.2f, 0, 0.6f}, {0, 0.6f, 0}, brick);
    add_quad(scene, {0.3f, 0.6f, 0.6f}, {-0.2f, 0, 0.6f}, {0.6f, 0, 0.2f}, brick);
    add_point_light(scene, {-0.8f, 1.8f, -0.2f}, {4, 4, 4});
    set_camera(scene, {0, 1.2, -1.5}, {0, 0.3, 1.2}, 60);
    scene.camera.width = scene.camera.height = 32;
    return scene;
}

/// A court of 2 × 2 between walls of different colours, open above to a sky that is brighter on one side.
inline Scene court_under_sky() {
    Scene scene;
    const uint white = add_material(scene, lambertian({0.7f, 0.7f, 0.7f}));
    const uint red = add_material(scene, lambertian({0.6f, 0.1f, 0.1f}));
    const uint green = add_material(scene, lambertian({0.1f, 0.5f, 0.1f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);  // floor
    add_quad(scene, {-1, -1, 1}, {0, 1.6f, 0}, {2, 0, 0}, white);
    add_quad(scene, {-1, -1, -1}, {0, 1.6f, 0}, {0, 0, 2}, red);
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 1.6f, 0}, green);
    add_quad(scene, {-0.3f, -0.3f, 0.1f}, {0, 0, 0.5f}, {0.6f, 0, 0.1f}, white);  // a block's top and front
    add_quad(scene, {-0.3f, -1, 0.1f}, {0, 0.7f, 0}, {0.6f, 0, 0.1f}, white);
    scene.environment = {.width = 2,
                         .height = 2,
                         .radiance = {{2, 2, 2}, {0.5f, 0.5f, 1}, {0.1f, 0.1f, 0.1f}, {0, 0, 0}},
                         .to_world = {}};
    set_camera(scene, {0.1, 0.3, -1.4}, {0, -0.4, 1}, 70);
    scene.camera.width = scene.camera.height = 32;
    return scene;
}

/// Views from scenes/ that were chosen against close-range sampling; the READMEs there explain them.
inline Scene hard_view(const std::string& name) {
    Scene scene = load_scene(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "scenes" / name / "scene.xml");
    scene.camera.width = scene.camera.height = 32;
    return scene;
}
/// A view of an empty wall, with the lamp and the furniture behind the camera.
inline Scene wall_view() {
    return hard_view("wall");
}
/// A view of a whole room.
inline Scene whole_room_view() {
    return hard_view("whole-room");
}
/// A view of a room that is lit through a door.
inline Scene next_room_view() {
    return hard_view("next-room");
}

/// Mean of a channel over the picture.
inline double channel_mean(const Image& image, std::string_view channel) {
    const auto index = static_cast<std::size_t>(image.find_channel(channel));
    double sum = 0;
    for (std::size_t i = index; i < image.values.size(); i += image.channel_count()) {
        sum += image.values[i];
    }
    return sum / (double(image.width) * image.height);
}

/// Standard deviation of the mean of R over the picture, by the picture's own variance channel.
inline double standard_error(const Image& image) {
    return std::sqrt(channel_mean(image, "variance.R") / (double(image.width) * image.height));
}

/// An environment map with a different colour in each of 21 neighbouring pixels.
inline EnvironmentLight patterned_map(int width, int height) {
    EnvironmentLight environment;
    environment.width = width;
    environment.height = height;
    for (int i = 0; i < width * height; ++i) {
        environment.radiance.push_back({0.1f * static_cast<float>(i % 7), static_cast<float>(i % 3), 0.5f});
    }
    return environment;
}

}  // namespace nearlight::core::small_scenes
