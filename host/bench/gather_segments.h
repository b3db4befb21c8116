// SPDX-License-Identifier: Apache-2.0
// A set of shadow rays that any tracer can be given: what a gather asks, without the renderer around it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/cl/device.h"
#include "host/scene/scene.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// One bit a (receiver, VPL) pair: bit `lane` of word packet·vpl_count + vpl.
using PairMask = std::vector<std::uint64_t>;

/// Segments from VPLs to receivers, each asked whether a triangle cuts it strictly between the fractions
/// NEARLIGHT_SEGMENT_T_MIN and NEARLIGHT_SEGMENT_T_MAX of its length.
struct GatherSegments {
    Scene geometry;  ///< vertices and triangles that block light; one material, no lights, no camera
    std::vector<Vpl> vpls;
    std::vector<ReceiverPacket> receivers;
    float clamp_radius = 0.0f;  ///< R of the bounded geometry term, scene units
    PairMask rays;              ///< pairs that are segments; the others were culled

    [[nodiscard]] std::size_t word(std::size_t packet, std::size_t vpl) const {
        return packet * vpls.size() + vpl;
    }
};

/// The opaque triangles of the scene, and those pairs that face each other: both cosines positive, and a
/// finite geometry term. The culling is plain host code, so a set is the same whatever device measures it.
GatherSegments make_gather_segments(const Scene& scene, std::vector<Vpl> vpls,
                                    std::vector<ReceiverPacket> receivers, float clamp_radius);

/// What the camera sees at `width` × `height` pixels, lit by `vpl_count` VPLs of light walks
/// (gather_workload.h).
GatherSegments make_camera_segments(const Scene& scene, const Bvh& bvh, std::size_t vpl_count, int width,
                                    int height);

/// The same with the VPLs and the clamp radius of a render with default settings: unequal powers, many near
/// the camera.
GatherSegments make_rendered_segments(Device& device, const Scene& scene, const Bvh& bvh,
                                      std::size_t vpl_count, int width, int height);

std::uint64_t count_bits(std::span<const std::uint64_t> mask);
/// Pairs whose receiver is there.
std::uint64_t count_pairs(const GatherSegments& segments);

}  // namespace nearlight::core
