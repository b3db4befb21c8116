// SPDX-License-Identifier: Apache-2.0
// Divides a picture into bands and batches of samples that fit a device.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "host/cl/device.h"
#include "host/stages/camera_pass.h"

namespace nearlight::core {

/// Bands of whole tile rows from top to bottom, each of which is rendered in batches of samples. The first
/// band may be shorter, so that first rows appear soon. No bit of the picture depends on the plan.
struct RenderPlan {
    uint tile_rows_in_first = 1;  ///< at most tile_rows_per_band
    uint tile_rows_per_band = 1;
    uint tile_row_count = 0;
    uint samples_per_batch = 1;
    uint samples_per_pixel = 1;
    uint branch_count = 1;

    [[nodiscard]] uint band_count() const {
        const uint others = tile_row_count - std::min(tile_row_count, tile_rows_in_first);
        return std::min(tile_row_count, 1u) + (others + tile_rows_per_band - 1) / tile_rows_per_band;
    }
    /// The batches of band `index`, in the order to render them.
    [[nodiscard]] std::vector<CameraBand> batches(uint index) const;
    /// The number of consecutive packets in a batch that Russian roulette may decide about together
    /// (BundleLayout): those of a tile, whose samples are divided so that bundles stay whole, or, if a tile's
    /// packets do not fill a bundle, those of a row of tiles.
    [[nodiscard]] uint run_packets(const CameraBand& batch, uint width) const;
    /// The maximum number of packets in a batch.
    [[nodiscard]] std::size_t max_packets(uint width) const;
};

/// The bytes that one receiver takes in all buffers of a batch.
inline constexpr std::size_t kBytesPerReceiver =
    (sizeof(ReceiverPacket) + 3 * sizeof(IrradiancePacket)) / NEARLIGHT_PACKET_SIZE + sizeof(CameraVertex);

/// Makes one plan for all devices. Its batches fit each device, and there are enough bands for faster devices
/// to take more.
RenderPlan make_plan(std::span<const Device* const> devices, uint width, uint height, uint samples_per_pixel,
                     uint branch_count);

}  // namespace nearlight::core
