// SPDX-License-Identifier: Apache-2.0
// Shares the bands of one picture among several devices that work at the same time.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

struct FinishedBand {
    std::vector<float> rows;       ///< from top to bottom, as band_floats_per_pixel() describes them
    std::size_t local_lights = 0;  ///< number of local lights that were made for the band
};
/// Takes how far a piece of work is, from 0 to 1, and returns false to stop it.
using WorkProgress = std::function<bool(double fraction)>;
/// Makes band `index`. Returns nothing if `progress` stopped it.
using BandMaker = std::function<std::optional<FinishedBand>(uint index, const WorkProgress& progress)>;

/// One device that takes part. `start` and the function that it returns are called in a thread of the
/// worker's own.
struct BandWorker {
    std::string name;  ///< device's name for messages
    std::function<BandMaker()> start;
    /// A band that only this worker may take, and takes first.
    std::optional<uint> first_band{};
    /// Called once when there is no band to take for now.
    std::function<void()> wait{};
};

/// What one worker did.
struct BandShare {
    std::string name;
    uint bands = 0;      ///< finished
    double seconds = 0;  ///< spent on bands, failed bands included
    bool failed = false;
};
struct BandOutcome {
    std::vector<BandShare> shares;  ///< one per worker, in their order
    bool interrupted = false;       ///< `progress` stopped the work; bands are missing
};

/// Workers take bands [0, band_count) from one queue, so that the faster ones take more. `sink` gets the
/// finished bands from first to last, and `progress` gets how far the picture is; both are called in the
/// caller's thread. Only the `window` bands that follow those handed to the sink may be begun, which bounds
/// how many wait for the sink. A worker that throws takes no further part: a warning says why, and the others
/// make its band. If no worker is left, the last one's exception is rethrown.
BandOutcome share_bands(uint band_count, uint window, std::span<const BandWorker> workers,
                        const std::function<void(FinishedBand& band)>& sink, const WorkProgress& progress);

/// Adds the shares of another picture to `sum`. They are in the order of `sum`, but devices that have failed
/// since may be missing. An empty `sum` becomes a copy of `shares`.
void add_shares(std::span<const BandShare> shares, std::vector<BandShare>& sum);

}  // namespace nearlight::core
