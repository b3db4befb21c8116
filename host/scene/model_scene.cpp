// SPDX-License-Identifier: Apache-2.0
#include "host/scene/model_scene.h"

#include "host/scene/default_view.h"
#include "host/scene/named_choice.h"

namespace nearlight::core {

void finish_model(Scene& scene, const LoadOptions& options, NoteSink& notes) {
    choose_named(scene.source, "camera", {}, options.camera);
    add_default_camera(scene, notes);
    if (!options.overrides.bring_light()) {
        add_default_light(scene, true, notes);
    }
    scene.has_open_exposure = true;
}

}  // namespace nearlight::core
