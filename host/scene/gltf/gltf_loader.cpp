// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_loader.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "host/scene/default_view.h"
#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/lights_and_cameras.h"
#include "host/scene/gltf/materials.h"
#include "host/scene/gltf/meshes.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace gltf {
namespace {

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
            matrix = rotation_of(node.rotation) * matrix;
        }
        if (node.translation.size() == 3) {
            matrix = translation(node.translation[0], node.translation[1], node.translation[2]) * matrix;
        }
    }
    for (const double number : matrix.m) {
        if (!std::isfinite(number)) {
            file.fail("the transform of node '" + node.name + "' is not finite");
        }
    }
    return matrix;
}

/// Calls visit(node, to_world) for the node and all nodes below it. Each may be there only once, because
/// nodes that share children could make any number of copies from a small file.
template <typename Visit>
void visit_nodes(const GltfFile& file, int index, const Mat4& parent, std::set<int>& visited,
                 const Visit& visit) {
    const tinygltf::Node& node = file.at(file.model.nodes, index, "node", "a scene or node");
    if (!visited.insert(index).second) {
        file.fail("node " + std::to_string(index) + " is its own ancestor, or has two parents");
    }
    const Mat4 to_world = parent * transform_of(file, node);
    visit(node, to_world);
    for (const int child : node.children) {
        visit_nodes(file, child, to_world, visited, visit);
    }
}

template <typename Visit>
void visit_scene(const GltfFile& file, const Visit& visit) {
    const tinygltf::Model& model = file.model;
    if (model.scenes.empty()) {
        file.fail("has no scene");
    }
    const tinygltf::Scene& scene =
        file.at(model.scenes, std::max(model.defaultScene, 0), "scene", "the file");
    std::set<int> visited;
    for (const int root : scene.nodes) {
        visit_nodes(file, root, {}, visited, visit);
    }
}

void check_parameters(const GltfFile& file, const LoadOptions& options) {
    for (const auto& [name, value] : options.parameters) {
        if (name != "camera") {
            throw Error(ErrorKind::invalid_argument,
                        file.path.string() + ": has no parameter '" + name +
                            "'; for glTF files, only -D camera=NAME is supported");
        }
    }
}

}  // namespace
}  // namespace gltf

Scene load_gltf_scene(const std::filesystem::path& path, const LoadOptions& options) {
    const gltf::GltfFile file = gltf::read_gltf(path);
    gltf::check_parameters(file, options);
    Scene scene;
    scene.source = path;
    scene.name = path.stem().string();
    NoteSink notes(scene.notes, options.strict);
    gltf::MaterialMaker materials(file, scene, notes);
    std::vector<gltf::PlacedLight> lights;
    std::vector<gltf::PlacedCamera> cameras;
    gltf::visit_scene(file, [&](const tinygltf::Node& node, const Mat4& to_world) {
        gltf::add_mesh(file, node, to_world, materials, scene, notes);
        gltf::find_light(file, node, to_world, lights);
        gltf::find_camera(file, node, to_world, cameras);
    });
    gltf::add_lights(file, lights, scene, notes);
    const auto wanted = options.parameters.find("camera");
    if (wanted != options.parameters.end() || !cameras.empty()) {
        scene.camera =
            gltf::choose_camera(file, cameras, wanted == options.parameters.end() ? "" : wanted->second);
        add_default_light(scene, notes);
    } else {
        add_default_view(scene, notes);
    }
    return scene;
}

}  // namespace nearlight::core
