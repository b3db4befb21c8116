// SPDX-License-Identifier: Apache-2.0
// Renders a picture of several passes.
#pragma once

#include "host/session/render.h"

namespace nearlight::core {

/// The parameters of render().
struct PassesTask {
    const RenderStart& start;
    const RowSink& sink;
    const WorkProgress& progress;
    const ForecastSink& forecast;
    const PassWatcher& watcher;
    const VplMaker& vpls;
    PassStart pass_start;
};

/// Makes passes as a PassSchedule says, and sends their mean.
void render_passes(Session& session, const RenderSettings& settings, PassesTask task, RenderReport& report);

}  // namespace nearlight::core
