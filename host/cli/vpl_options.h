// SPDX-License-Identifier: Apache-2.0
// The options of `nearlight render` that keep VPLs in files.
#pragma once

#include <filesystem>

#include "host/cli/command.h"
#include "host/session/session.h"

namespace nearlight::core {

struct VplFiles {
    std::filesystem::path save;  ///< empty: VPLs are not kept
    std::filesystem::path load;  ///< empty: a sampler makes the VPLs
};

/// Adds --save-vpls and --load-vpls. The options of the sampler must have been added before.
void add_vpl_options(CLI::App& command, VplFiles& files);

/// Puts the file that VPLs come from into the settings. Throws Error(ErrorKind::invalid_argument) if VPLs are
/// to be saved of a picture that may have several passes, because each pass has its own.
void settle(const VplFiles& files, RenderSettings& settings);

/// Saves the VPLs if that was asked for.
void save(const VplFiles& files, Session& session, const View& view, const VplSet& vpls);

}  // namespace nearlight::core
