// SPDX-License-Identifier: Apache-2.0
// The oracle of the camera pass, by Embree: what it must find at pixel centres where no surface has S.
#pragma once

#include <span>

#include "host/base/math.h"
#include "host/reference/embree_scene.h"
#include "host/scene/camera.h"

namespace nearlight::core {

struct CameraComparison {
    std::size_t receivers = 0;  ///< receivers that are present
    std::size_t absent = 0;     ///< lanes beside the picture, and pixels that see nothing
    /// Lanes away from edges whose position, normal, albedo, depth or close range differs.
    std::size_t mismatches = 0;
};

/// Compares a camera pass over the whole picture, made as one band of one sample and one branch, with Embree.
CameraComparison compare_with_embree(const Scene& scene, const Camera& camera, const CloseRange& close_range,
                                     std::span<const ReceiverPacket> receivers,
                                     std::span<const CameraVertex> vertices);

}  // namespace nearlight::core
