// SPDX-License-Identifier: Apache-2.0
// The order in which the receivers of a batch of camera samples are stored.
#ifndef NEARLIGHT_SHARED_PACKET_ORDER_H
#define NEARLIGHT_SHARED_PACKET_ORDER_H

#include "shared/types.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// Each tile of pixels has a packet of receivers for each of its samples and branches. A tile has 8 x 8
/// pixels, which are neighbours or, if the picture is interleaved, stand `interleave` pixels apart; then as
/// many tiles as fit between them cover the same square of the picture. Packets of one branch stand together
/// for a few neighbouring tiles and a few consecutive samples. A gather takes consecutive packets together
/// (lib/bundle.cl), so this decides what a bundle holds: several samples of one tile, or one sample of
/// several tiles.
typedef struct PacketOrder {
    uint tile_columns;    // of the picture, filled up to whole bundles
    uint sample_count;    // samples of the batch
    uint branch_count;    // receivers of each sample
    uint bundle_columns;  // tiles that stand together, side by side
    uint bundle_rows;     // tiles that stand together, one below the other
    uint bundle_samples;  // consecutive samples that stand together; divides sample_count
    uint interleave;  // distance of a tile's pixels; tile_columns is a multiple of bundle_columns times it
} PacketOrder;

// The next functions are about one axis of the picture. `together` is the number of tiles along it that stand
// together; these follow one another and are alike in where their pixels stand in each square of
// interleave x interleave pixels.

/// The pixel at the place `lane`, from 0 to 7, of a tile.
NEARLIGHT_SHARED_FUNCTION uint pixel_of_tile(uint tile, uint lane, uint together, uint interleave) {
    const uint span = together * interleave;
    const uint first = tile / span * span + tile % together * interleave;
    return first * NEARLIGHT_TILE_SIZE + lane * interleave + tile % span / together;
}
/// The tile that has a pixel.
NEARLIGHT_SHARED_FUNCTION uint tile_of_pixel(uint pixel, uint together, uint interleave) {
    const uint square = pixel / (NEARLIGHT_TILE_SIZE * interleave);
    return square / together * together * interleave + pixel % interleave * together + square % together;
}
/// The place of a pixel in its tile.
NEARLIGHT_SHARED_FUNCTION uint lane_of_pixel(uint pixel, uint interleave) {
    return pixel / interleave % NEARLIGHT_TILE_SIZE;
}

/// Where a pixel stands in a launch: its tile, and its lane in the packets of that tile.
typedef struct PixelPlace {
    uint column, row;
    uint lane;
} PixelPlace;
NEARLIGHT_SHARED_FUNCTION PixelPlace place_of_pixel(PacketOrder order, uint x, uint y) {
    PixelPlace place;
    place.column = tile_of_pixel(x, order.bundle_columns, order.interleave);
    place.row = tile_of_pixel(y, order.bundle_rows, order.interleave);
    place.lane =
        lane_of_pixel(y, order.interleave) * NEARLIGHT_TILE_SIZE + lane_of_pixel(x, order.interleave);
    return place;
}

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
