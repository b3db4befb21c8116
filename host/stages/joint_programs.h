// SPDX-License-Identifier: Apache-2.0
// The programs that stages share on CPUs. A stage names its own where it makes its Program.
#pragma once

#include "host/cl/program.h"

namespace nearlight::core {

/// What makes a picture from receivers.
inline constexpr JointProgram kViewProgram{"joint/view.cl"};
/// Walks through the scene.
inline constexpr JointProgram kWalksProgram{"joint/walks.cl"};
/// The small stages that every sampler draws on.
inline constexpr JointProgram kVplsProgram{"joint/vpls.cl"};

}  // namespace nearlight::core
