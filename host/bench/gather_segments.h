// SPDX-License-Identifier: Apache-2.0
// The set of shadow rays of a gather, which any tracer can be given without the renderer around it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/cl/device.h"
#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// One bit per pair of a receiver and a VPL: bit `lane` of word packet·vpl_count + vpl.
using PairMask = std::vector<std::uint64_t>;

/// Segments from VPLs to receivers, each asked whether a triangle cuts it strictly between the fractions
/// NEARLIGHT_SEGMENT_T_MIN and NEARLIGHT_SEGMENT_T_MAX of its length.
struct GatherSegments {
    Scene geometry;  ///< vertices and triangles that block light; one material, no lights, no camera
    std::vector<Vpl> vpls;
    std::vector<ReceiverPacket> receivers;
    float clamp_radius = 0.0f;  ///< R of the bounded geometry term, m
    PairMask rays;              ///< pairs that are segments; the other pairs were culled

    [[nodiscard]] std::size_t word(std::size_t packet, std::size_t vpl) const {
        return packet * vpls.size() + vpl;
    }
};

/// The set of the pairs that face each other (both cosines are positive and the geometry term is finite),
/// with the scene's opaque triangles. The culling is plain host code, so the set does not depend on the
/// device.
GatherSegments make_gather_segments(const Scene& scene, std::vector<Vpl> vpls,
                                    std::vector<ReceiverPacket> receivers, float clamp_radius);

/// Segments between what the camera sees at `width` × `height` pixels and `vpl_count` VPLs of walks
/// (gather_workload.h).
GatherSegments make_camera_segments(const Scene& scene, const Bvh& bvh, std::size_t vpl_count, int width,
                                    int height);

/// Segments between what the camera sees and the VPLs of a render with default settings, with its clamp
/// radius. The VPLs have unequal powers, and many of them are near the camera.
GatherSegments make_rendered_segments(Device& device, const Scene& scene, const Bvh& bvh,
                                      std::size_t vpl_count, int width, int height);

/// Number of bits that are set.
std::uint64_t count_bits(std::span<const std::uint64_t> mask);
/// Number of pairs whose receiver is present.
std::uint64_t count_pairs(const GatherSegments& segments);

}  // namespace nearlight::core
