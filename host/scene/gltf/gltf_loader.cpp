// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_loader.h"

#include "host/scene/default_view.h"
#include "host/scene/gltf/animation.h"
#include "host/scene/gltf/gltf_file.h"
#include "host/scene/gltf/lights_and_cameras.h"
#include "host/scene/gltf/meshes.h"
#include "host/scene/gltf/nodes.h"
#include "host/scene/model_scene.h"
#include "host/scene/scene_overrides.h"

namespace nearlight::core {
namespace {

std::vector<gltf::PlacedCamera> cameras_of(const gltf::GltfFile& file,
                                           const std::vector<gltf::PlacedNode>& nodes) {
    std::vector<gltf::PlacedCamera> cameras;
    for (const gltf::PlacedNode& placed : nodes) {
        gltf::find_camera(file, placed, cameras);
    }
    return cameras;
}

gltf::MeshMaker add_meshes(const gltf::GltfFile& file, const std::vector<gltf::PlacedNode>& nodes,
                           gltf::MaterialMaker& materials, Scene& scene, NoteSink& notes) {
    gltf::MeshMaker meshes(file, scene, materials, notes);
    for (const gltf::PlacedNode& placed : nodes) {
        meshes.add(placed);
    }
    return meshes;
}

/// A camera that frames the nodes at rest, so that it stays where it is while they move. Their meshes are
/// made once more, of the same file and with the same materials.
void add_still_camera(gltf::GltfFile& file, std::vector<tinygltf::Node> nodes_at_rest,
                      gltf::MaterialMaker& materials, bool is_placed, Scene& scene, NoteSink& notes) {
    Scene rest;
    rest.source = scene.source;
    file.model.nodes.swap(nodes_at_rest);
    add_meshes(file, gltf::place_nodes(file), materials, rest, notes);
    file.model.nodes.swap(nodes_at_rest);
    add_default_camera(rest, is_placed, notes);
    scene.camera = rest.camera;
}

}  // namespace

Scene load_gltf_scene(const std::filesystem::path& path, const LoadOptions& options) {
    gltf::GltfFile file = gltf::read_gltf(path);
    Scene scene = begin_model(path);
    NoteSink notes(scene.notes, options.strict);
    gltf::note_unread_extensions(file, notes);
    if (options.lists_animations) {
        scene.animations = gltf::list_animations(file);
    }
    std::vector<tinygltf::Node> nodes_at_rest;
    if (options.moment) {
        nodes_at_rest = file.model.nodes;
        scene.animation = gltf::pose_nodes(file, *options.moment, notes);
    }
    const std::vector<gltf::PlacedNode> nodes = gltf::place_nodes(file);
    scene.pose = options.moment ? gltf::pose_hash(file, nodes) : 0;
    gltf::MaterialMaker materials(file, scene, notes);
    gltf::MeshMaker meshes = add_meshes(file, nodes, materials, scene, notes);
    std::vector<gltf::PlacedLight> lights;
    for (const gltf::PlacedNode& placed : nodes) {
        gltf::find_light(file, placed, lights);
    }
    gltf::add_lights(file, lights, scene, notes);
    const std::vector<gltf::PlacedCamera> cameras = cameras_of(file, nodes);
    const bool is_placed = options.overrides.origin.has_value();
    if (!options.camera.empty() || !cameras.empty()) {
        scene.camera = gltf::choose_camera(file, cameras, options.camera);
    } else if (options.moment) {
        add_still_camera(file, std::move(nodes_at_rest), materials, is_placed, scene, notes);
    } else {
        add_default_camera(scene, is_placed, notes);
    }
    meshes.add_seen_backs(eye_of(scene, options.overrides));
    if (!options.overrides.bring_light()) {
        // A file with a camera is a scene, which surfaces that shine light. Without one it is a model, of
        // which some parts may glow.
        const bool surfaces_are_lamps = !cameras.empty();
        add_default_light(scene, surfaces_are_lamps, notes);
    }
    scene.has_open_exposure = true;
    scene.open_veils = true;
    return scene;
}

std::optional<GltfCameras> gltf_cameras_of(const Scene& scene, const LoadOptions& options) {
    gltf::GltfFile file = gltf::read_gltf(scene.source);
    std::vector<Note> said_before;
    NoteSink notes(said_before, false);
    gltf::pose_nodes(file, options.moment.value_or(SceneMoment{}), notes);
    const std::vector<gltf::PlacedNode> nodes = gltf::place_nodes(file);
    if (gltf::pose_hash(file, nodes) != scene.pose) {
        return std::nullopt;
    }
    const std::vector<gltf::PlacedCamera> cameras = cameras_of(file, nodes);
    return cameras.empty() ? GltfCameras{} : GltfCameras{gltf::choose_camera(file, cameras, options.camera)};
}

}  // namespace nearlight::core
