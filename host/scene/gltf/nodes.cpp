// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nearlight::core::gltf {
namespace {

/// Nodes that are no other's child.
std::vector<int> roots_of(const tinygltf::Model& model) {
    std::vector<bool> is_child(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) {
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) {
                is_child[static_cast<std::size_t>(child)] = true;
            }
        }
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
        if (!is_child[i]) {
            roots.push_back(static_cast<int>(i));
        }
    }
    return roots;
}

/// The rotation of a quaternion x, y, z, w of any length.
Mat4 quaternion_rotation(const std::vector<double>& quaternion) {
    const double angle =
        2 * std::atan2(std::hypot(quaternion[0], quaternion[1], quaternion[2]), quaternion[3]);
    const bool turns = quaternion[0] != 0 || quaternion[1] != 0 || quaternion[2] != 0;
    return turns ? rotation(quaternion[0], quaternion[1], quaternion[2], angle * 180 / std::numbers::pi)
                 : Mat4{};
}

/// The rotation of a node's transform. A matrix does not tell which axes it mirrors; it counts as one that
/// mirrors X. What has no rotation, because it maps an axis to a point, is left as it is.
Mat4 turn_of(const tinygltf::Node& node, const Mat4& transform) {
    if (node.matrix.size() != 16) {
        return node.rotation.size() == 4 ? quaternion_rotation(node.rotation) : Mat4{};
    }
    Mat4 turn;
    for (int column = 0; column < 3; ++column) {
        const double l = std::hypot(transform(0, column), transform(1, column), transform(2, column));
        for (int row = 0; row < 3; ++row) {
            turn(row, column) = transform(row, column) / (l > 0 ? l : 1.0);
        }
    }
    return linear_determinant(turn) < 0 ? turn * scaling(-1, 1, 1) : turn;
}

bool is_hidden(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    if (found == node.extensions.end() || !found->second.Has("visible")) {
        return false;
    }
    const tinygltf::Value& visible = found->second.Get("visible");
    return visible.IsBool() && !visible.Get<bool>();
}

/// The nodes at and below the roots. Chains may be long, so the way down is kept in a list and not on the
/// stack.
std::vector<PlacedNode> place_below(const GltfFile& file, const std::vector<int>& roots, bool with_hidden) {
    std::vector<PlacedNode> placed;
    std::vector<bool> visited(file.model.nodes.size());
    std::vector<PlacedNode> open;
    const auto add_in_order = [&](const std::vector<int>& nodes, const Mat4& parent, const Mat4& turn) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
            open.push_back({*node, parent, turn});
        }
    };
    add_in_order(roots, {}, {});
    while (!open.empty()) {
        const auto [index, parent, turn] = open.back();
        open.pop_back();
        const tinygltf::Node& node = file.at(file.model.nodes, index, "node", "a scene or node");
        if (visited[static_cast<std::size_t>(index)]) {
            file.fail("node " + std::to_string(index + 1) + " is its own ancestor, or has two parents");
        }
        visited[static_cast<std::size_t>(index)] = true;
        if (is_hidden(node) && !with_hidden) {
            continue;
        }
        const Mat4 own = transform_of(file, node);
        placed.push_back({index, parent * own, turn * turn_of(node, own)});
        add_in_order(node.children, placed.back().to_world, placed.back().turn);
    }
    return placed;
}

}  // namespace

Mat4 transform_of(const GltfFile& file, const tinygltf::Node& node) {
    Mat4 matrix;
    if (node.matrix.size() == 16) {  // column-major
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) {
                matrix(row, column) = node.matrix[static_cast<std::size_t>(4 * column + row)];
            }
        }
    } else {
        if (node.scale.size() == 3) {
            matrix = scaling(node.scale[0], node.scale[1], node.scale[2]);
        }
        if (node.rotation.size() == 4) {
            matrix = quaternion_rotation(node.rotation) * matrix;
        }
        if (node.translation.size() == 3) {
            matrix = translation(node.translation[0], node.translation[1], node.translation[2]) * matrix;
        }
    }
    if (!std::ranges::all_of(matrix.m, [](double number) { return std::isfinite(number); })) {
        file.fail("the transform of node '" + node.name + "' is not finite");
    }
    return matrix;
}

std::vector<PlacedNode> place_nodes(const GltfFile& file) {
    const tinygltf::Model& model = file.model;
    if (model.scenes.empty()) {
        if (model.nodes.empty()) {
            file.fail("has no scene");
        }
        return place_below(file, roots_of(model), false);
    }
    return place_below(
        file, file.at(model.scenes, std::max(model.defaultScene, 0), "scene", "the file").nodes, false);
}

std::vector<Mat4> world_transforms(const GltfFile& file) {
    std::vector<Mat4> transforms(file.model.nodes.size());
    for (const PlacedNode& node : place_below(file, roots_of(file.model), true)) {
        transforms[static_cast<std::size_t>(node.index)] = node.to_world;
    }
    return transforms;
}

}  // namespace nearlight::core::gltf
