// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj/obj_loader.h"

#include "host/scene/mesh.h"
#include "host/scene/model_scene.h"
#include "host/scene/note_sink.h"
#include "host/scene/obj/lamp_backs.h"
#include "host/scene/obj/obj_file.h"
#include "host/scene/obj/obj_materials.h"
#include "host/scene/polygon.h"
#include "host/scene/scene_overrides.h"

namespace nearlight::core {

Scene load_obj_scene(const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene = begin_model(file);
    NoteSink notes(scene.notes, options.strict);
    const ObjFile obj = read_obj(file, ObjUse::scene);
    note_what_is_left_out(obj, notes);
    if (obj.crooked_faces > 0) {
        notes.approximation(
            file, 0,
            std::to_string(obj.crooked_faces) + " faces with more than " + std::to_string(kMaxEarCorners) +
                " corners that are not convex are divided as if they were; divide them before");
    }
    const std::vector<uint> materials = add_obj_materials(scene, obj, notes);
    append_mesh(scene, obj.mesh, {.to_world = {}, .materials = materials}, notes);
    finish_model(scene, options, notes);
    add_lamp_backs(scene, obj.mesh, materials, eye_of(scene, options.overrides), notes);
    return scene;
}

}  // namespace nearlight::core
