// SPDX-License-Identifier: Apache-2.0
// Which reflections get receivers of their own.
#pragma once

#include "nearlight/settings.h"

namespace nearlight::core {

/// CameraBatch::min_weight, which is above 0 if rays bring light: reflections that weigh less then get no
/// receiver. A receiver asks all VPLs, and reflections lie scattered, so that the rays to their receivers
/// cost most; the noise of a traced path weighs as little as the reflection does.
inline float min_receiver_weight(const GatherSettings& settings) {
    constexpr float kMinReceiverWeight = 0.2f;
    return settings.compensate ? kMinReceiverWeight : 0.0f;
}

}  // namespace nearlight::core
