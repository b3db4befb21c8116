// SPDX-License-Identifier: Apache-2.0
// Bundles of receiver packets, which are gathered together and decide together in Russian roulette.
// kernels/lib/bundle.cl does the same on devices.
#pragma once

#include <algorithm>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Divides packets into bundles. The packets come in runs of one length, and a bundle is up to
/// NEARLIGHT_BUNDLE_PACKETS consecutive packets of a run, counted from its start. The bundles therefore stay
/// the same if a picture is cut between runs, or in a run after a multiple of NEARLIGHT_BUNDLE_PACKETS.
struct BundleLayout {
    uint packet_count = 0;  ///< in all runs; the last run may be incomplete
    uint run_packets = 1;   ///< packets in a run; at least 1

    struct Bundle {
        uint first = 0;
        uint count = 0;  ///< packets in the bundle; may be 0 in an incomplete run
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
