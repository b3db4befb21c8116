// SPDX-License-Identifier: Apache-2.0
// Mitsuba's skies: `sunsky` of Mitsuba 3, and `sky`, `sun` and `sunsky` of 0.5 and 0.6.
#pragma once

#include "host/scene/mitsuba/texture_maker.h"

namespace nearlight::core::mitsuba {

bool is_sky(const Object& emitter);

/// The sky as a map, with the sun as a disc of its own. `sky`, `sun` and what stands in an old file have the
/// conventions of Mitsuba 0.5 and 0.6, where +Y is up, and otherwise the model of Mitsuba 3's `sunsky`.
EnvironmentLight make_sky(const Object& emitter, NoteSink& notes);

}  // namespace nearlight::core::mitsuba
