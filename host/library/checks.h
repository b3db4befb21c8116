// SPDX-License-Identifier: Apache-2.0
// The rooms take settings as they are; callers of the library may have mistyped theirs.
#pragma once

#include <span>

#include "nearlight/session.h"

namespace nearlight {

// All throw Error(ErrorKind::invalid_argument) that names the setting.
void check(const ViewSettings& settings);
void check(const SamplingSettings& settings);
void check(const GatherSettings& settings);
void check(const IrradianceSettings& settings);
void check(const RenderSettings& settings);

/// As many normals as points, all of length 1.
void check_points(std::span<const Vec3> points, std::span<const Vec3> normals);

}  // namespace nearlight
