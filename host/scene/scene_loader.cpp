// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_loader.h"

#include <algorithm>
#include <string_view>

#include "host/base/files.h"
#include "host/scene/gltf/gltf_loader.h"
#include "host/scene/mitsuba/mitsuba_loader.h"
#include "host/scene/obj/obj_loader.h"
#include "host/scene/ply_scene.h"
#include "host/scene/scene_limits.h"
#include "host/scene/vertex_colors.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

struct Loader {
    std::string_view extension;
    Scene (*load)(const std::filesystem::path& file, const LoadOptions& options);
    bool has_parameters;  ///< `$name` stands for a value
    bool has_animations;
};
constexpr Loader kLoaders[] = {{".xml", load_mitsuba_scene, true, false},
                               {".gltf", load_gltf_scene, false, true},
                               {".glb", load_gltf_scene, false, true},
                               {".obj", load_obj_scene, false, false},
                               {".ply", load_ply_scene, false, false}};

void refuse_parameters(const std::filesystem::path& file, const LoadOptions& options) {
    if (!options.parameters.empty()) {
        throw Error(ErrorKind::invalid_argument, file.string() + ": has no parameter '" +
                                                     options.parameters.begin()->first +
                                                     "'; only Mitsuba scenes (.xml) have parameters");
    }
}

void refuse_animations(const std::filesystem::path& file, const LoadOptions& options) {
    if (options.moment) {
        throw Error(ErrorKind::invalid_argument,
                    file.string() + ": has no animations; only glTF scenes (.gltf, .glb) have animations",
                    "frames");
    }
}

/// Gives all vertices second texture coordinates if a texture is looked up there, because kernels read them
/// without asking.
void finish_second_uvs(Scene& scene) {
    const bool are_read = std::ranges::any_of(scene.textures, [](const SceneTexture& texture) {
        return (texture.parameters.flags & NEARLIGHT_TEXTURE_SECOND_UV) != 0;
    });
    if (are_read) {
        scene.second_uvs.resize(scene.vertices.size());
    }
}

// Adds remarks for scenes that are odd, although their black picture is correct.
void remark_emptiness(const Scene& scene, NoteSink& notes) {
    if (scene.triangles.empty()) {
        notes.remark(scene.source, 0, "the scene has no triangles");
    }
    if (!has_light(scene)) {
        notes.remark(scene.source, 0, "nothing in the scene emits light; the picture will be black");
    }
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        throw Error(ErrorKind::file, file.string() + ": no such scene file");
    }
    if (std::filesystem::is_directory(file, ignored)) {
        throw Error(ErrorKind::file, file.string() + ": is a folder; give the scene file in it");
    }
    const std::string extension = lower_case_extension(file);
    const auto loader = std::ranges::find(kLoaders, extension, &Loader::extension);
    if (loader == std::end(kLoaders)) {
        throw Error(ErrorKind::file, file.string() + ": unknown scene format '" + extension +
                                         "'; known ones are .xml (Mitsuba), .gltf, .glb, .obj and .ply");
    }
    if (!loader->has_parameters) {
        refuse_parameters(file, options);
    }
    if (!loader->has_animations) {
        refuse_animations(file, options);
    }
    Scene scene = loader->load(file, options);
    NoteSink notes(scene.notes, options.strict);
    apply_overrides(scene, options.overrides, notes);
    finish_vertex_colors(scene, notes);
    finish_second_uvs(scene);
    keep_within_limits(scene, notes);
    remark_emptiness(scene, notes);
    return scene;
}

std::optional<SceneCamera> camera_at(const Scene& scene, const LoadOptions& options) {
    const std::optional<GltfCameras> then = gltf_cameras_of(scene, options);
    if (!then) {
        return std::nullopt;
    }
    return then->own ? overridden(*then->own, scene, options.overrides) : scene.camera;
}

}  // namespace nearlight::core
