// SPDX-License-Identifier: Apache-2.0
// The command that renders what the window shows.
#pragma once

#include <span>
#include <string>

#include "nearlight/image.h"
#include "nearlight/settings.h"

namespace nearlight::viewer {

/// The command line of `nearlight render` for these settings. `scene_arguments` say what scene to load and
/// how. Settings that have the defaults are left out.
std::string command_text(std::span<const std::string> scene_arguments, const RenderSettings& settings,
                         const WriteOptions& look, const std::string& output);

/// The names of samplers, policies and tone curves, as the options have them.
const char* name_of(SamplerKind sampler);
const char* name_of(Policy policy);
const char* name_of(ToneCurve curve);

}  // namespace nearlight::viewer
