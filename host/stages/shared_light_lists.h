// SPDX-License-Identifier: Apache-2.0
// Lists of the lights that bundles of receivers share: those that each bundle uses of what the rays of its
// receivers found, and which receivers see them. The kernels are shared_light_choose in shared_lights.cl,
// shared_light_packets.cl and shared_light_rays.cl.
#pragma once

#include <limits>

#include "host/cl/kernel.h"
#include "host/stages/device_scene.h"
#include "host/stages/receiver_paths.h"
#include "kernels/shared/shared_light.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// What hides a shared light from receivers.
enum class Hiding {
    surfaces,  ///< all surfaces
    solids,    ///< all but veils, whose transmittance is left to the gather
};

/// What bundles share of what their rays find.
struct SharedLightKind {
    uint shares = 0;  ///< one of NEARLIGHT_SHARES_…, which gives each kind random numbers of its own
    uint count = 0;   ///< about how many a bundle uses
    float max_distance = std::numeric_limits<float>::infinity();  ///< of lights from their receivers, m
    Hiding hiding = Hiding::surfaces;
};

/// Stages that bring the light of shared lights make lists and use them at once, so that one object, with its
/// device memory, serves all of them.
class SharedLightLists {
  public:
    /// Begins to compile the kernels. `kernel` is that of the gather.
    SharedLightLists(Device& device, GatherKernel kernel);

    /// Lists for each bundle about as many of the lights that ReceiverPaths::run_sharing() found as the kind
    /// says. The tree of the scene must be uploaded for the gather kernel.
    void make(const ReceiverBatch& batch, const SharedLightKind& kind, const Buffer<SharedLight>& found);

    /// Calls visit(buffer) for listed, factors, lengths and seen_by, in the order in which kernels take them.
    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        visit(listed_), visit(factors_), visit(lengths_), visit(seen_by_);
    }

  private:
    void make_room(std::size_t bundle_count);

    Device* device_;
    GatherKernel kernel_;  ///< never `automatic`
    Program program_;
    Kernel choose_;
    Kernel visibility_;
    // NEARLIGHT_SHARED_LIST entries for each bundle.
    Buffer<uint> listed_;       ///< the receivers that found the lights
    Buffer<float> factors_;     ///< shared_factor() of each light
    Buffer<uint> lengths_;      ///< of the lists
    Buffer<uint> seen_by_;      ///< for each entry a bit for each receiver of the bundle
    Buffer<uint> next_bundle_;  ///< the queue of shared_light_packets: a single counter
};

}  // namespace nearlight::core
