// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/meshes.h"

#include <numeric>

namespace nearlight::core::gltf {
namespace {

std::vector<Vec3> read_vectors(const GltfFile& file, int accessor) {
    const std::vector<float> numbers = read_numbers(file, accessor, 3);
    std::vector<Vec3> vectors(numbers.size() / 3);
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        vectors[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    }
    return vectors;
}

/// Reads texture coordinates. v is 0 at the top of an image in glTF, and at its bottom in a Mesh.
std::vector<std::array<float, 2>> read_uvs(const GltfFile& file, int accessor) {
    const std::vector<float> numbers = read_numbers(file, accessor, 2);
    std::vector<std::array<float, 2>> uvs(numbers.size() / 2);
    for (std::size_t i = 0; i < uvs.size(); ++i) {
        uvs[i] = {numbers[2 * i], 1.0f - numbers[2 * i + 1]};
    }
    return uvs;
}

std::vector<std::array<uint, 3>> triangles_of(int mode, const std::vector<uint>& corners) {
    std::vector<std::array<uint, 3>> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
        }
        return triangles;
    }
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            triangles.push_back({corners[i + 1], corners[i + 2], corners[0]});
        } else {  // every other triangle of a strip runs the other way round
            triangles.push_back({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
        }
    }
    return triangles;
}

bool makes_triangles(int mode) {
    return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

/// The accessor of an attribute, or −1 if there is none.
int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

Mesh read_mesh(const GltfFile& file, const tinygltf::Primitive& primitive, int texture_set) {
    Mesh mesh;
    mesh.source = file.path;
    mesh.positions = read_vectors(file, attribute(primitive, "POSITION"));
    if (const int normals = attribute(primitive, "NORMAL"); normals >= 0) {
        mesh.normals = read_vectors(file, normals);
    }
    if (const int uvs = attribute(primitive, "TEXCOORD_" + std::to_string(texture_set)); uvs >= 0) {
        mesh.uvs = read_uvs(file, uvs);
    }
    std::vector<uint> corners(mesh.positions.size());
    std::iota(corners.begin(), corners.end(), 0u);
    if (primitive.indices >= 0) {
        corners = read_indices(file, primitive.indices);
    }
    mesh.triangles = triangles_of(primitive.mode, corners);
    return mesh;
}

void remark_what_is_left_out(const GltfFile& file, const tinygltf::Node& node,
                             const tinygltf::Primitive& primitive, NoteSink& notes) {
    if (!makes_triangles(primitive.mode)) {
        notes.approximation(file.path, 0, "points and lines are left out");
    }
    if (node.skin >= 0 || !primitive.targets.empty()) {
        notes.approximation(file.path, 0,
                            "skins and morph targets are ignored; their meshes are shown as modelled");
    }
    if (attribute(primitive, "COLOR_0") >= 0) {
        notes.approximation(file.path, 0, "vertex colours are left out");
    }
}

}  // namespace

void add_mesh(const GltfFile& file, const tinygltf::Node& node, const Mat4& to_world,
              MaterialMaker& materials, Scene& scene, NoteSink& notes) {
    if (node.mesh < 0) {
        return;
    }
    const tinygltf::Mesh& mesh = file.at(file.model.meshes, node.mesh, "mesh", "node '" + node.name + "'");
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
        remark_what_is_left_out(file, node, primitive, notes);
        if (makes_triangles(primitive.mode) && attribute(primitive, "POSITION") >= 0) {
            const PlacedMaterial material = materials.material(primitive.material);
            append_mesh(scene, read_mesh(file, primitive, material.texture_set),
                        {.to_world = to_world, .materials = std::span(&material.index, 1)}, notes);
        }
    }
}

}  // namespace nearlight::core::gltf
