// SPDX-License-Identifier: Apache-2.0
// Scenes of files that hold surfaces alone.
#pragma once

#include "host/scene/note_sink.h"
#include "host/scene/scene_loader.h"

namespace nearlight::core {

/// Completes such a scene: with the default camera, the default light unless the options bring some, and an
/// open exposure. Throws Error(ErrorKind::invalid_argument) if the options ask for another camera.
void finish_model(Scene& scene, const LoadOptions& options, NoteSink& notes);

}  // namespace nearlight::core
