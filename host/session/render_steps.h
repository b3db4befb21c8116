// SPDX-License-Identifier: Apache-2.0
// The steps of one pass of a picture, and what they add to its report.
#pragma once

#include "host/session/render.h"

namespace nearlight::core {

/// The products of look and sample, which a gather needs.
struct Prepared {
    View view;
    VplSet vpls{};
    RenderSettings settings;  ///< of the pass
};

/// Looks at the scene.
View look(Session& session, const RenderSettings& settings, RenderReport& report);

/// Looks at the scene and makes VPLs, with `vpls` unless that is empty. `settings` are those of the pass.
Prepared prepare(Session& session, const RenderSettings& settings, const VplMaker& vpls,
                 RenderReport& report);

/// Gathers the rows of the pass.
void gather(Session& session, const Prepared& pass, const RowSink& sink, const GatherFraction& progress,
            RenderReport& report);

}  // namespace nearlight::core
