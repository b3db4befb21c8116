// SPDX-License-Identifier: Apache-2.0
// Bundles of receiver packets, which are gathered together and ask about the same VPLs. kernels/lib/bundle.cl
// does the same on devices.
#pragma once

#include <algorithm>

#include "host/base/division.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// The number of receivers of a bundle that is not the last.
inline constexpr uint kBundleReceivers = NEARLIGHT_BUNDLE_PACKETS * NEARLIGHT_PACKET_SIZE;

/// Divides packets into bundles of NEARLIGHT_BUNDLE_PACKETS consecutive ones; the last bundle may have fewer.
/// kernels/shared/packet_order.h decides which packets of a picture follow one another.
struct BundleLayout {
    uint packet_count = 0;

    struct Bundle {
        uint first = 0;
        uint count = 0;  ///< packets in the bundle
    };
    [[nodiscard]] constexpr uint bundle_count() const {
        return divide_rounding_up(packet_count, NEARLIGHT_BUNDLE_PACKETS);
    }
    [[nodiscard]] constexpr Bundle bundle(uint index) const {
        const uint first = index * NEARLIGHT_BUNDLE_PACKETS;
        return {first,
                std::min<uint>(NEARLIGHT_BUNDLE_PACKETS, packet_count - std::min(first, packet_count))};
    }
};

}  // namespace nearlight::core
