// SPDX-License-Identifier: Apache-2.0
// Bundles of receiver packets: what a gather takes through the tree together, and what decides together in
// its Russian roulette. kernels/lib/bundle.cl is the same on devices.
#pragma once

#include <algorithm>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Packets in runs of the same length. A bundle is up to NEARLIGHT_BUNDLE_PACKETS of a run that follow one
/// another, counted from the run's first, so that where a picture is cut between runs, or in a run after a
/// multiple of so many, the bundles are the same.
struct BundleLayout {
    uint packet_count = 0;  ///< of all runs; the last may be incomplete
    uint run_packets = 1;   ///< at least 1

    struct Bundle {
        uint first = 0;
        uint count = 0;  ///< packets; may be 0 in an incomplete run
    };
    [[nodiscard]] constexpr uint run_bundles() const {
        return (run_packets + NEARLIGHT_BUNDLE_PACKETS - 1) / NEARLIGHT_BUNDLE_PACKETS;
    }
    [[nodiscard]] constexpr uint bundle_count() const {
        return (packet_count + run_packets - 1) / run_packets * run_bundles();
    }
    [[nodiscard]] constexpr Bundle bundle(uint index) const {
        const uint run = index / run_bundles() * run_packets;
        const uint first = run + index % run_bundles() * NEARLIGHT_BUNDLE_PACKETS;
        const uint end = std::min({first + NEARLIGHT_BUNDLE_PACKETS, run + run_packets, packet_count});
        return {first, end > first ? end - first : 0};
    }
};

}  // namespace nearlight::core
