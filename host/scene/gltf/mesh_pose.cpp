// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/mesh_pose.h"

#include <cmath>

namespace nearlight::core::gltf {
namespace {

/// Adds `weight` times the accessor's vectors; there may be more or fewer than in the mesh.
void add_scaled(const GltfFile& file, int accessor, double weight, std::vector<Vec3>& vectors) {
    const std::vector<float> numbers = read_numbers(file, accessor, 3);
    const auto w = static_cast<float>(weight);
    for (std::size_t i = 0; i < vectors.size() && 3 * i + 2 < numbers.size(); ++i) {
        vectors[i] += w * Vec3{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    }
}

/// A weighted sum of matrices.
Mat4 blended(const GltfFile& file, const std::vector<Mat4>& joints, std::span<const float> indices,
             std::span<const float> weights, Mat4 sum) {
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (weights[i] == 0.0f) {
            continue;
        }
        if (!(indices[i] >= 0.0f) || !(indices[i] < static_cast<float>(joints.size()))) {
            file.fail("a vertex refers to joint " + std::to_string(static_cast<int>(indices[i])) +
                      ", but its skin has only " + std::to_string(joints.size()));
        }
        const Mat4& joint = joints[static_cast<std::size_t>(indices[i])];
        for (std::size_t k = 0; k < 16; ++k) {
            sum.m[k] += static_cast<double>(weights[i]) * joint.m[k];
        }
    }
    return sum;
}

}  // namespace

void apply_morph_targets(const GltfFile& file, const tinygltf::Node& node, const tinygltf::Mesh& source,
                         const tinygltf::Primitive& primitive, Mesh& mesh, NoteSink& notes) {
    const std::vector<double>& weights = node.weights.empty() ? source.weights : node.weights;
    for (std::size_t i = 0; i < primitive.targets.size() && i < weights.size(); ++i) {
        if (weights[i] == 0.0 || !std::isfinite(weights[i])) {
            continue;
        }
        for (const auto& [name, accessor] : primitive.targets[i]) {
            if (name == "POSITION") {
                add_scaled(file, accessor, weights[i], mesh.positions);
            } else if (name == "NORMAL") {
                add_scaled(file, accessor, weights[i], mesh.normals);
            } else if (name != "TANGENT") {
                notes.approximation(file.path, 0, "morph targets of " + name + " are left out");
            }
        }
    }
}

std::vector<Mat4> joint_transforms(const GltfFile& file, const tinygltf::Skin& skin,
                                   const std::vector<Mat4>& world) {
    std::vector<float> bind;
    if (skin.inverseBindMatrices >= 0) {
        bind = read_numbers(file, skin.inverseBindMatrices, 16);
        if (bind.size() < 16 * skin.joints.size()) {
            file.fail("skin '" + skin.name + "' has fewer matrices than joints");
        }
    }
    std::vector<Mat4> joints;
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        file.at(file.model.nodes, skin.joints[i], "node", "skin '" + skin.name + "'");
        Mat4 inverse_bind;
        for (int k = 0; k < 16 && !bind.empty(); ++k) {  // column-major
            inverse_bind(k % 4, k / 4) = static_cast<double>(bind[16 * i + static_cast<std::size_t>(k)]);
        }
        joints.push_back(world[static_cast<std::size_t>(skin.joints[i])] * inverse_bind);
    }
    return joints;
}

void apply_skin(const GltfFile& file, const PrimitiveData& data, const std::vector<Mat4>& joints,
                Mesh& mesh) {
    std::vector<Mat4> transforms(mesh.positions.size());
    for (Mat4& transform : transforms) {
        transform.m.fill(0);
    }
    for (int set = 0; data.has("JOINTS_" + std::to_string(set)); ++set) {
        const std::vector<float> indices = data.read("JOINTS_" + std::to_string(set), 4);
        const std::vector<float> weights = data.read("WEIGHTS_" + std::to_string(set), 4);
        for (std::size_t i = 0; i < transforms.size() && 4 * i + 3 < std::min(indices.size(), weights.size());
             ++i) {
            transforms[i] = blended(file, joints, std::span(indices).subspan(4 * i, 4),
                                    std::span(weights).subspan(4 * i, 4), transforms[i]);
        }
    }
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        Mat4& transform = transforms[i];
        const double total = transform(3, 3);  // of the weights, which rounding leaves beside 1
        if (!(total > 0)) {
            continue;
        }
        for (double& number : transform.m) {
            number /= total;
        }
        mesh.positions[i] = transform_point(transform, mesh.positions[i]);
        if (i < mesh.normals.size()) {
            const double sign = linear_determinant(transform) < 0 ? -1.0 : 1.0;
            mesh.normals[i] = transform_normal(transform, sign, mesh.normals[i]);
        }
    }
}

}  // namespace nearlight::core::gltf
