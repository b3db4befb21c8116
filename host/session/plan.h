// SPDX-License-Identifier: Apache-2.0
// Divides a picture into bands and batches of samples that fit a device.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "host/base/division.h"
#include "host/cl/device.h"
#include "host/stages/camera_pass.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// Bands of whole tile rows from top to bottom, each of which is rendered in batches of samples. The first
/// band may be shorter, so that first rows appear soon. No bit of the picture depends on the plan.
struct RenderPlan {
    PixelWindow cover;            ///< the pixels of whole bundles that hold all wanted ones
    uint tile_rows_in_first = 1;  ///< at most tile_rows_per_band
    uint tile_rows_per_band = 1;
    uint tile_row_count = 0;  ///< of `cover`
    uint samples_per_batch = 1;
    uint samples_per_pixel = 1;
    uint branch_count = 1;
    uint strata = 1;          ///< of the set of VPLs
    uint bundle_columns = 1;  ///< tiles in a bundle, side by side
    uint bundle_rows = 1;     ///< tiles in a bundle, one below the other
    uint bundle_samples = 1;  ///< consecutive samples of each of these tiles in a bundle
    uint interleave = 1;      ///< distance of a tile's pixels (PacketOrder)
    uint tile_columns = 0;    ///< of `cover`, filled up as in PacketOrder

    [[nodiscard]] uint band_count() const {
        const uint others = tile_row_count - std::min(tile_row_count, tile_rows_in_first);
        return std::min(tile_row_count, 1u) + divide_rounding_up(others, tile_rows_per_band);
    }
    /// The batches of band `index`, in the order to render them.
    [[nodiscard]] std::vector<CameraBatch> batches(uint index) const;
    /// The strata of the first bundles of a batch, which repeat after these (VplStrata). A pixel's samples
    /// take turns with the strata, in runs of equal length if the number of samples allows it, so that the
    /// strata of the first half of the samples lie spread over the set, as do those of the second; `seed`
    /// decides which are which. In an interleaved picture, each pixel of a square of interleave x interleave
    /// has strata of its own if there are enough.
    [[nodiscard]] std::vector<uint> strata_of_bundles(const CameraBatch& batch, uint seed) const;
    /// The maximum number of packets in a batch.
    [[nodiscard]] std::size_t max_packets() const;
};

/// What a plan divides.
struct PictureSize {
    uint width = 0;
    uint height = 0;
    uint samples_per_pixel = 1;
    uint branch_count = 1;
    uint strata = 1;
    uint interleave = 1;                  ///< a power of two
    std::optional<PixelWindow> window{};  ///< the wanted part of it; empty: all
};

/// The number of receivers in a batch that keep a device busy and fit its memory.
std::size_t receivers_per_batch(const Device& device);

/// Makes one plan for all devices, whose receivers_per_batch() are given. Its batches fit each device, unless
/// a single row of bundles is more already, because a batch has at least one. There are enough bands for
/// faster devices to take more. Bands and batches are cut so that all bundles are whole and the same for
/// every plan.
RenderPlan make_plan(std::span<const std::size_t> batch_receivers, const PictureSize& picture);

}  // namespace nearlight::core
