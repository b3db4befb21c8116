// SPDX-License-Identifier: Apache-2.0
// Which reflections get receivers of their own.
#pragma once

#include "nearlight/settings.h"

namespace nearlight::core {

/// CameraBatch::min_weight, above 0 if rays bring light. Reflections that weigh less get no receiver then. A
/// receiver asks all VPLs, and reflections lie scattered, so that theirs cost most; the noise of a traced
/// path weighs as little as the reflection does.
inline float min_receiver_weight(const GatherSettings& settings) {
    constexpr float kMinReceiverWeight = 0.2f;
    return settings.compensate ? kMinReceiverWeight : 0.0f;
}

}  // namespace nearlight::core
