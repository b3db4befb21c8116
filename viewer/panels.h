// SPDX-License-Identifier: Apache-2.0
// The panels beside the picture: settings, layers, saving, and what lights a pixel.
#pragma once

#include "viewer/frame.h"
#include "viewer/state.h"

namespace nearlight::viewer {

inline constexpr float kPanelWidth = 330.0f;

/// What the panels tell besides the settings.
struct PanelFacts {
    const Frame* frame = nullptr;  ///< null before the first
    bool has_scene = false;
    bool is_done = false;
    std::string error{};  ///< of the latest step; empty if there is none
};

/// Draws the panel of settings, and returns what the user changed in `state`.
Changes draw_settings_panel(ViewerState& state, const PanelFacts& facts);

/// Draws the panel that says what lights the inspected pixel.
void draw_inspection_panel(const Inspection& inspection);

}  // namespace nearlight::viewer
