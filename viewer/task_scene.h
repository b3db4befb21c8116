// SPDX-License-Identifier: Apache-2.0
// The scene that a window shows.
#pragma once

#include "viewer/viewer.h"

namespace nearlight::viewer {

/// Loads it. Throws what Scene::load() throws, and Error(ErrorKind::out_of_memory) if its picture is too
/// large for a window.
inline Scene load_scene(const ViewerTask& task) {
    Scene scene = Scene::load(task.scene, task.load);
    check_size(task.settings.view.width.value_or(scene.width()),
               task.settings.view.height.value_or(scene.height()));
    return scene;
}

}  // namespace nearlight::viewer
