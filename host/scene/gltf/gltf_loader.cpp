// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_loader.h"

#include <cmath>

#include "host/scene/default_view.h"
#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/lights_and_cameras.h"
#include "host/scene/gltf/meshes.h"
#include "host/scene/gltf/nodes.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace gltf {
namespace {

void check_parameters(const GltfFile& file, const LoadOptions& options) {
    for (const auto& [name, value] : options.parameters) {
        if (name != "camera") {
            throw Error(ErrorKind::invalid_argument,
                        file.path.string() + ": has no parameter '" + name +
                            "'; for glTF files, only -D camera=NAME is supported");
        }
    }
}

std::string wanted_camera(const LoadOptions& options) {
    const auto found = options.parameters.find("camera");
    return options.camera.empty() && found != options.parameters.end() ? found->second : options.camera;
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
    gltf::MeshMaker meshes(file, scene, notes);
    std::vector<gltf::PlacedLight> lights;
    std::vector<gltf::PlacedCamera> cameras;
    for (const gltf::PlacedNode& placed : gltf::place_nodes(file)) {
        const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(placed.index)];
        meshes.add(placed);
        gltf::find_light(file, node, placed.to_world, lights);
        gltf::find_camera(file, node, placed.to_world, cameras);
    }
    gltf::add_lights(file, lights, scene, notes);
    const std::string wanted = gltf::wanted_camera(options);
    if (!wanted.empty() || !cameras.empty()) {
        scene.camera = gltf::choose_camera(file, cameras, wanted);
    } else {
        add_default_camera(scene, notes);
    }
    if (!options.overrides.bring_light()) {
        // A file with a camera is a scene, whose lamps light it. Without one it is a model, of which some
        // parts may glow.
        add_default_light(scene, cameras.empty() ? INFINITY : 0.0f, notes);
    }
    scene.has_open_exposure = true;
    return scene;
}

}  // namespace nearlight::core
