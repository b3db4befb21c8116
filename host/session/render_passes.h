// SPDX-License-Identifier: Apache-2.0
// Renders a picture of several passes.
#pragma once

#include "host/session/render.h"

namespace nearlight::core {

/// Makes passes as a PassSchedule says, and sends their mean. The parameters are those of render().
void render_passes(Session& session, const RenderSettings& settings, const RenderStart& start,
                   const RowSink& sink, const GatherFraction& progress, const ForecastSink& forecast,
                   RenderReport& report);

}  // namespace nearlight::core
