// SPDX-License-Identifier: Apache-2.0
// Which packets of receivers go through the tree together, and with Russian roulette ask about the same VPLs.
// host/base/receiver_bundles.h is the same on the host, and says why.
#ifndef NEARLIGHT_LIB_BUNDLE
#define NEARLIGHT_LIB_BUNDLE

#include "shared/types.h"

/// `count` packets, each `stride` after the one before; 0: none.
typedef struct Bundle {
    uint first, stride, count;
} Bundle;

/// The packets are rows of `row_tiles` tiles of `tile_packets` packets; the last row may be incomplete.
#define BUNDLE_PARAMETERS uint packet_count, uint tile_packets, uint row_tiles
#define BUNDLE_ARGUMENTS packet_count, tile_packets, row_tiles

inline Bundle bundle_at(uint index, BUNDLE_PARAMETERS) {
    const uint row_bundles =
        (row_tiles + NEARLIGHT_BUNDLE_PACKETS - 1) / NEARLIGHT_BUNDLE_PACKETS * tile_packets;
    const uint row = index / row_bundles;
    const uint tile = index % row_bundles / tile_packets * NEARLIGHT_BUNDLE_PACKETS;
    const uint first = (row * row_tiles + tile) * tile_packets + index % tile_packets;
    const uint there = first < packet_count ? (packet_count - first + tile_packets - 1) / tile_packets : 0;
    const Bundle bundle = {first, tile_packets,
                           min(min(row_tiles - tile, there), (uint)NEARLIGHT_BUNDLE_PACKETS)};
    return bundle;
}

inline uint bundle_packet(const Bundle* bundle, uint index) {
    return bundle->first + index * bundle->stride;
}

#endif
