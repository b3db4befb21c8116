// SPDX-License-Identifier: Apache-2.0
// How far a picture is, by how far its bands are.
#pragma once

#include <vector>

#include "host/scene/scene.h"
#include "host/session/plan.h"
#include "host/stages/camera_pass.h"

namespace nearlight::core {

/// About how much work the parts of a picture are, in strips of equal height from its top to its bottom, in
/// any unit: a pixel of sky costs a twentieth of a receiver, and surfaces that also reflect like mirrors cost
/// twice as much as others. Counts the receivers of a small picture, whose paths are followed as those of
/// `batch`; this takes milliseconds.
std::vector<double> work_of_strips(Device& device, CameraPass& camera_pass, const DeviceScene& scene,
                                   const SceneCamera& camera, const CameraBatch& batch, uint seed);

/// The part of a picture's work that is done when that part of its bands is, both from 0 to 1. `height` is
/// that of the whole picture in pixels, and `strips` are its work. Bands are finished about in order.
double part_of_work(const RenderPlan& plan, uint height, const std::vector<double>& strips,
                    double part_of_bands);

}  // namespace nearlight::core
