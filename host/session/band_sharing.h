// SPDX-License-Identifier: Apache-2.0
// Bands of one picture, worked on by several devices at once.
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
    std::vector<float> rows;       ///< width · NEARLIGHT_LAYER_CHANNELS floats each, top to bottom
    std::size_t local_lights = 0;  ///< that were made for it
};
/// How far something is, 0 to 1; returns false to stop.
using BandProgress = std::function<bool(double fraction)>;
/// Makes band `index`; empty where `progress` stopped it.
using BandMaker = std::function<std::optional<FinishedBand>(uint index, const BandProgress& progress)>;

/// One device that takes part. `start` and what it returns are called in a thread of the worker's own.
struct BandWorker {
    std::string name;  ///< for messages
    std::function<BandMaker()> start;
};

/// What one worker did.
struct BandShare {
    std::string name;
    uint bands = 0;      ///< finished
    double seconds = 0;  ///< spent on bands, those that failed included
    bool failed = false;
};
struct BandOutcome {
    std::vector<BandShare> shares;  ///< of the workers, in their order
    bool interrupted = false;       ///< by `progress`; bands are missing
};

/// Workers take bands [0, band_count) from one queue, so that the faster ones take more. `sink` gets the
/// finished bands from first to last, and `progress` how far the picture is; both are called in the caller's
/// thread. No band further than `window` behind the first that is missing is begun, which bounds how many
/// wait for the sink. A worker that throws takes no more part: a warning says why, and the others make its
/// band. Rethrows what the last one threw.
BandOutcome share_bands(uint band_count, uint window, std::span<const BandWorker> workers,
                        const std::function<void(FinishedBand& band)>& sink, const BandProgress& progress);

/// Adds what the workers of another picture did. Its devices are those of `sum` in their order, but for some
/// that are no longer there; the first picture's are taken as they are.
void add_shares(std::span<const BandShare> shares, std::vector<BandShare>& sum);

}  // namespace nearlight::core
