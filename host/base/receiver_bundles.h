// SPDX-License-Identifier: Apache-2.0
// Bundles of receiver packets: what a gather takes through the tree together, and what decides together in
// its Russian roulette. kernels/lib/bundle.cl is the same on devices.
#pragma once

#include <algorithm>
#include <cstddef>

#include "kernels/shared/types.h"

namespace nearlight {

/// Rows of tiles of packets, tile by tile. A bundle is packet i of up to NEARLIGHT_BUNDLE_PACKETS tiles that
/// follow one another in a row, so that no division of a picture into bands of rows or batches of samples
/// divides a bundle.
struct BundleLayout {
    uint packet_count = 0;  ///< of all rows; the last row may be incomplete
    uint tile_packets = 1;
    uint row_tiles = 1;

    /// So many packets that are simply taken in their order.
    static constexpr BundleLayout in_order(std::size_t packet_count) {
        const auto count = static_cast<uint>(packet_count);
        return {count, 1, std::max(count, 1u)};
    }

    struct Bundle {
        uint first = 0;
        uint stride = 1;
        uint count = 0;  ///< may be 0 in an incomplete row
    };
    [[nodiscard]] constexpr uint row_bundles() const {
        return (row_tiles + NEARLIGHT_BUNDLE_PACKETS - 1) / NEARLIGHT_BUNDLE_PACKETS * tile_packets;
    }
    [[nodiscard]] constexpr uint bundle_count() const {
        const uint row_packets = row_tiles * tile_packets;
        return (packet_count + row_packets - 1) / row_packets * row_bundles();
    }
    [[nodiscard]] constexpr Bundle bundle(uint index) const {
        const uint row = index / row_bundles();
        const uint tile = index % row_bundles() / tile_packets * NEARLIGHT_BUNDLE_PACKETS;
        const uint end_tile = std::min<uint>(row_tiles, tile + NEARLIGHT_BUNDLE_PACKETS);
        Bundle result{(row * row_tiles + tile) * tile_packets + index % tile_packets, tile_packets, 0};
        while (tile + result.count < end_tile && result.first + result.count * tile_packets < packet_count) {
            ++result.count;
        }
        return result;
    }
};

}  // namespace nearlight
