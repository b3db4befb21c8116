// SPDX-License-Identifier: Apache-2.0
// The programs that stages share on CPUs. Each stage names one of them where it makes its Program.
#pragma once

#include "host/cl/program.h"

namespace nearlight::core {

/// The stages that make receivers and turn them into a picture.
inline constexpr JointProgram kViewProgram{"joint/view.cl"};
/// The small stages that every sampler draws on.
inline constexpr JointProgram kVplsProgram{"joint/vpls.cl"};

}  // namespace nearlight::core
