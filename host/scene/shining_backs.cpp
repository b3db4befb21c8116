// SPDX-License-Identifier: Apache-2.0
#include "host/scene/shining_backs.h"

#include "host/scene/material_model.h"
#include "host/scene/ray_epsilon.h"
#include "host/scene/scene_names.h"

namespace nearlight::core {

uint add_back_material(Scene& scene, uint front) {
    const uint model = scene.materials[front].model;
    if (model == NEARLIGHT_BSDF_TWO_SIDED || model == NEARLIGHT_BSDF_DIFFUSE) {
        return front;
    }
    Material back = plain_material(NEARLIGHT_BSDF_NULL);
    back.emission = scene.materials[front].emission;
    scene.materials.push_back(back);
    const auto added = static_cast<uint>(scene.materials.size() - 1);
    if (front < scene.material_names.size()) {
        name_material(scene, added, std::string(scene.material_names[front]));
    }
    return added;
}

void add_shining_back(Scene& scene, Mesh mesh, const Mat4& to_world, std::span<const uint> materials,
                      NoteSink& notes) {
    if (mesh.normals.empty()) {
        mesh.normals = smooth_normals(mesh.positions, mesh.triangles);
    }
    const std::size_t first = scene.vertices.size();
    append_mesh(scene, mesh, {.to_world = to_world, .materials = materials, .flip_normals = true}, notes);
    Aabb box;
    for (std::size_t i = first; i < scene.vertices.size(); ++i) {
        box.extend(scene.vertices[i].position);
    }
    const float extent = max_component(box.size());
    for (std::size_t i = first; i < scene.vertices.size(); ++i) {
        Vertex& vertex = scene.vertices[i];
        vertex.position += vertex.normal * (4.0f * ray_epsilon(vertex.position, extent));
    }
}

}  // namespace nearlight::core
