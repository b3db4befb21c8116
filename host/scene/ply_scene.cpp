// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_scene.h"

#include "host/scene/crease_normals.h"
#include "host/scene/mesh.h"
#include "host/scene/model_scene.h"
#include "host/scene/note_sink.h"
#include "host/scene/places.h"
#include "host/scene/ply_loader.h"
#include "host/scene/vertex_colors.h"

namespace nearlight::core {

Scene load_ply_scene(const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene = begin_model(file);
    NoteSink notes(scene.notes, options.strict);
    Mesh mesh = read_ply(file);
    decode_display_colors(mesh.colors);
    if (mesh.normals.empty()) {
        add_crease_normals(mesh, places_of(mesh.positions),
                           std::vector<uint>(mesh.triangles.size(), kSmoothByAngle));
    }
    const std::vector<uint> materials{add_plain_surface(scene, !mesh.colors.empty())};
    append_mesh(scene, mesh, {.to_world = {}, .materials = materials}, notes);
    finish_model(scene, options, notes);
    return scene;
}

}  // namespace nearlight::core
