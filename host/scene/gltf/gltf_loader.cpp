// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_loader.h"

#include "host/scene/default_view.h"
#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/lights_and_cameras.h"
#include "host/scene/gltf/meshes.h"
#include "host/scene/gltf/nodes.h"

namespace nearlight::core {
Scene load_gltf_scene(const std::filesystem::path& path, const LoadOptions& options) {
    const gltf::GltfFile file = gltf::read_gltf(path);
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
    if (!options.camera.empty() || !cameras.empty()) {
        scene.camera = gltf::choose_camera(file, cameras, options.camera);
    } else {
        add_default_camera(scene, notes);
    }
    if (!options.overrides.bring_light()) {
        // A file with a camera is a scene, which surfaces that shine light. Without one it is a model, of
        // which some parts may glow.
        const bool surfaces_are_lamps = !cameras.empty();
        add_default_light(scene, surfaces_are_lamps, notes);
    }
    scene.has_open_exposure = true;
    return scene;
}

}  // namespace nearlight::core
