// SPDX-License-Identifier: Apache-2.0
#include "host/scene/model_scene.h"

#include "host/scene/default_view.h"
#include "host/scene/material_model.h"
#include "host/scene/named_choice.h"
#include "host/scene/texture_loader.h"

namespace nearlight::core {

Scene begin_model(const std::filesystem::path& file) {
    Scene scene;
    scene.source = file;
    scene.name = file.stem().string();
    return scene;
}

uint add_plain_surface(Scene& scene, bool has_colors) {
    Material surface = diffuse_material({0.5f, 0.5f, 0.5f});
    if (has_colors) {
        surface.reflectance = textured(add_texture(scene, vertex_color_texture()));
    }
    return add_two_sided(scene, surface);
}

void finish_model(Scene& scene, const LoadOptions& options, NoteSink& notes) {
    choose_named(scene.source, "camera", {}, options.camera);
    add_default_camera(scene, options.overrides.origin.has_value(), notes);
    if (!options.overrides.bring_light()) {
        add_default_light(scene, true, notes);
    }
    scene.has_open_exposure = true;
    scene.open_veils = true;
}

}  // namespace nearlight::core
