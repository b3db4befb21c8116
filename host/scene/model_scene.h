// SPDX-License-Identifier: Apache-2.0
// Scenes of files that hold models: surfaces, but no camera of their own and often no light.
#pragma once

#include <filesystem>

#include "host/scene/note_sink.h"
#include "host/scene/scene_loader.h"

namespace nearlight::core {

/// An empty scene that has the name of the file.
Scene begin_model(const std::filesystem::path& file);

/// Adds the two-sided material of a surface for which the file has none: grey, or the colours of vertices or
/// faces if they have some. Returns its index.
uint add_plain_surface(Scene& scene, bool has_colors);

/// Completes the scene: with the default camera, the default light unless the options bring some, and an open
/// exposure. Throws Error(ErrorKind::invalid_argument) if the options ask for another camera.
void finish_model(Scene& scene, const LoadOptions& options, NoteSink& notes);

}  // namespace nearlight::core
