// SPDX-License-Identifier: Apache-2.0
// The order in which the receivers of a batch of camera samples are stored.
#ifndef NEARLIGHT_SHARED_PACKET_ORDER_H
#define NEARLIGHT_SHARED_PACKET_ORDER_H

#include "shared/vec3.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// Each tile of pixels has a packet of receivers for each of its samples and branches. Packets of one branch
/// stand together for a few neighbouring tiles and a few consecutive samples. A gather takes consecutive
/// packets together (lib/bundle.cl), so this decides what a bundle holds: several samples of one tile, or one
/// sample of several tiles.
typedef struct PacketOrder {
    uint tile_columns;    // of the picture, filled up to whole bundles
    uint sample_count;    // samples of the batch
    uint branch_count;    // receivers of each sample
    uint bundle_columns;  // tiles that stand together, side by side
    uint bundle_rows;     // tiles that stand together, one below the other
    uint bundle_samples;  // consecutive samples that stand together; divides sample_count
} PacketOrder;

/// The place of a packet, for the tile at `column` and `row` of the batch.
NEARLIGHT_SHARED_FUNCTION uint packet_at(PacketOrder order, uint column, uint row, uint sample, uint branch) {
    const uint across = order.tile_columns / order.bundle_columns;
    const uint square = row / order.bundle_rows * across + column / order.bundle_columns;
    const uint runs = order.sample_count / order.bundle_samples;
    const uint run = (square * runs + sample / order.bundle_samples) * order.branch_count + branch;
    const uint place = run * order.bundle_samples + sample % order.bundle_samples;
    const uint tile = row % order.bundle_rows * order.bundle_columns + column % order.bundle_columns;
    return place * (order.bundle_columns * order.bundle_rows) + tile;
}

#ifdef __cplusplus
}  // namespace nearlight::core
#endif

#endif
