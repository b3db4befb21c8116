// SPDX-License-Identifier: Apache-2.0
// Renders a picture of several passes.
#pragma once

#include "host/session/render.h"

namespace nearlight::core {

/// Makes passes as a PassSchedule says, and sends their mean.
void render_passes(Session& session, const RenderSettings& settings, const RenderHooks& hooks,
                   PassStart start, RenderReport& report);

}  // namespace nearlight::core
