// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/scene_check.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "nearlight/error.h"

namespace nearlight::core::fuzz {
namespace {

void require(bool holds, const char* what) {
    if (!holds) {
        std::fprintf(stderr, "the scene breaks a promise: %s\n", what);
        std::abort();
    }
}

bool is_in(int index, std::size_t count) {
    return index >= 0 && static_cast<std::size_t>(index) < count;
}

void check_geometry(const Scene& scene) {
    for (const Triangle& triangle : scene.triangles) {
        const bool known = std::max({triangle.v0, triangle.v1, triangle.v2}) < scene.vertices.size();
        require(known && triangle.material < scene.materials.size(), "triangles refer to what is there");
    }
    for (const Vertex& vertex : scene.vertices) {
        require(is_finite(vertex.position) && is_finite(vertex.normal), "vertices are finite");
        require(std::isfinite(vertex.u) && std::isfinite(vertex.v), "texture coordinates are finite");
    }
    require(scene.vertex_colors.empty() || scene.vertex_colors.size() == scene.vertices.size(),
            "all vertices have colours, or none");
    require(scene.second_uvs.empty() || scene.second_uvs.size() == scene.vertices.size(),
            "all vertices have second texture coordinates, or none");
}

void check_names(const Scene& scene) {
    require(std::ranges::is_sorted(scene.objects, {}, &ObjectRun::first_triangle),
            "objects are in the order of their triangles");
    for (const ObjectRun& object : scene.objects) {
        require(object.name < scene.object_names.size() && object.first_triangle <= scene.triangles.size(),
                "objects have names and triangles");
    }
    require(scene.material_names.size() <= scene.materials.size(), "names are those of materials");
}

void check_looks(const Scene& scene) {
    for (const SceneTexture& texture : scene.textures) {
        require(texture.image == -1 || is_in(texture.image, scene.images.size()),
                "textures have their images");
    }
    for (const Material& material : scene.materials) {
        require(is_finite(material.emission.value), "emission is finite");
    }
    const EnvironmentLight& sky = scene.environment;
    require(sky.radiance.size() == static_cast<std::size_t>(sky.width) * static_cast<std::size_t>(sky.height),
            "the environment has its pixels");
    require(std::ranges::all_of(sky.radiance, is_finite), "the environment is finite");
}

void check_camera(const SceneCamera& camera) {
    require(camera.width >= 1 && camera.height >= 1, "the picture has pixels");
    require(camera.fov_x_degrees > 0.0 && camera.fov_x_degrees < 180.0, "the field of view is one");
}

}  // namespace

void load_and_check(const std::filesystem::path& file, const LoadOptions& options) {
    try {
        const Scene scene = load_scene(file, options);
        check_geometry(scene);
        check_names(scene);
        check_looks(scene);
        check_camera(scene.camera);
    } catch (const Error&) {
        return;  // was refused
    }
}

}  // namespace nearlight::core::fuzz
