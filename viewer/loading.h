// SPDX-License-Identifier: Apache-2.0
// Reads the scene of a task.
#pragma once

#include "viewer/renderer.h"
#include "viewer/viewer.h"

namespace nearlight::viewer {

/// Reads the scene and places the camera as the task says. Throws as Scene::load() does.
inline LoadedScene load(const ViewerTask& task) {
    const Scene scene = Scene::load(task.scene, task.load);
    std::optional<CameraPose> camera = task.choose_camera ? task.choose_camera(scene.camera()) : std::nullopt;
    return {.scene = scene, .camera = std::move(camera)};
}

}  // namespace nearlight::viewer
