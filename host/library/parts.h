// SPDX-License-Identifier: Apache-2.0
// What several of the handles in include/nearlight/ are made of.
#pragma once

#include <filesystem>
#include <optional>

#include "host/scene/scene_loader.h"
#include "host/session/render.h"
#include "nearlight/scene.h"
#include "nearlight/session.h"

namespace nearlight {

/// The options for the rooms inside, at a moment of the file's animations or at rest.
core::LoadOptions core_options(const LoadOptions& options, std::optional<core::SceneMoment> moment = {});
/// The scene at that moment.
core::Scene load_core_scene(const std::filesystem::path& file, const LoadOptions& options,
                            std::optional<core::SceneMoment> moment = {});

/// A picture of settings that have been checked. `vpls` makes its VPLs unless it is empty.
Picture render_picture(core::Session& session, const RenderSettings& settings, const Progress& progress,
                       const core::VplMaker& vpls = {});

}  // namespace nearlight
