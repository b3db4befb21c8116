// SPDX-License-Identifier: Apache-2.0
#include "host/stages/veil_trees.h"

#include "host/scene/reflectance.h"

namespace nearlight::core {
namespace {

/// Whether each triangle is a veil.
std::vector<bool> find_veils(const Scene& scene) {
    std::vector<bool> of_materials;
    for (const Material& material : scene.materials) {
        of_materials.push_back(is_veil(scene, material));
    }
    std::vector<bool> veils;
    veils.reserve(scene.triangles.size());
    for (const Triangle& triangle : scene.triangles) {
        veils.push_back(of_materials[triangle.material]);
    }
    return veils;
}

std::vector<BvhTriangle> without(const std::vector<bool>& veils, const Bvh& tree) {
    std::vector<BvhTriangle> triangles = tree.triangles;
    for (std::size_t slot = 0; slot < triangles.size(); ++slot) {
        const uint id = tree.triangle_ids[slot];
        if (id < veils.size() && veils[id]) {
            triangles[slot] = {.v0 = triangles[slot].v0, .edge1 = {}, .edge2 = {}, .normal = {}};
        }
    }
    return triangles;
}

std::vector<TriangleBlock> without(const std::vector<bool>& veils, const WideBvh& tree) {
    std::vector<TriangleBlock> blocks = tree.blocks;
    for (std::size_t slot = 0; slot < tree.triangle_ids.size(); ++slot) {
        const uint id = tree.triangle_ids[slot];
        if (id < veils.size() && veils[id]) {
            TriangleBlock& block = blocks[slot / NEARLIGHT_BLOCK_TRIANGLES];
            const std::size_t column = slot % NEARLIGHT_BLOCK_TRIANGLES;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                block.edge1[axis][column] = block.edge2[axis][column] = 0.0f;
            }
        }
    }
    return blocks;
}

}  // namespace

VeilTrees make_veil_trees(Device& device, const Scene& scene, const ShapedBvh& tree,
                          const TreeShapes& shapes) {
    const std::vector<bool> veils = find_veils(scene);
    std::vector<uint> ids;
    for (std::size_t i = 0; i < veils.size(); ++i) {
        if (veils[i]) {
            ids.push_back(static_cast<uint>(i));
        }
    }
    VeilTrees trees;
    if (shapes.binary) {
        trees.solid_triangles = {device, without(veils, tree.binary)};
    }
    if (shapes.wide) {
        trees.solid_blocks = {device, without(veils, tree.wide)};
    }
    trees.veils = upload_ray_tree(device, build_bvh(scene, ids));
    return trees;
}

}  // namespace nearlight::core
