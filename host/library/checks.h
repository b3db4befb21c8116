// SPDX-License-Identifier: Apache-2.0
// Checks of the settings that callers of the library give, because the rooms use settings unchecked.
#pragma once

#include <span>
#include <string>

#include "nearlight/image.h"
#include "nearlight/session.h"

namespace nearlight {

// All these functions throw Error(ErrorKind::invalid_argument), which names the setting that is out of range.
void check(const ViewSettings& settings);
void check(const SamplingSettings& settings);
void check(const GatherSettings& settings);
void check(const IrradianceSettings& settings);
void check(const RenderSettings& settings);
void check(const AnimationOptions& options);
/// The number of a frame.
void check_frame(int frame);

/// Throws Error(ErrorKind::invalid_argument), whose message begins with `problem`, unless the image has as
/// many values as its width times its height times its channels.
void check_values(const std::string& problem, const Image& image);

/// Throws Error(ErrorKind::invalid_argument) unless there are as many normals as points, points are finite
/// and normals have length 1.
void check_points(std::span<const Vec3> points, std::span<const Vec3> normals);

}  // namespace nearlight
