// SPDX-License-Identifier: Apache-2.0
// The state of a picture that is made in passes, from which another process can go on.
#pragma once

#include <optional>
#include <vector>

#include "host/samplers/sampler.h"
#include "host/session/pass_schedule.h"
#include "host/session/pass_sums.h"

namespace nearlight::core {

/// Consecutive passes with one seed.
struct PassRange {
    uint seed = 0;
    uint first = 0;             ///< number of the first of them
    std::vector<uint> samples;  ///< per pixel, of each pass

    [[nodiscard]] uint end() const { return first + static_cast<uint>(samples.size()); }
};

/// What pass 0 decides for all passes with its seed.
struct PassChoice {
    float range = 0.0f;  ///< m
    RayBudget ray_budget{};

    friend bool operator==(const PassChoice&, const PassChoice&) = default;
};

/// What a report counts over all passes. Of a pass with which another process goes on, the local lights of
/// the rows before are not counted.
struct PassTotals {
    std::size_t close_vpls = 0;
    std::size_t distant_vpls = 0;
    std::size_t sparse_vpls = 0;   ///< VPLs that only lit other VPLs
    std::size_t candidates = 0;    ///< candidates that VPLs were chosen from; 0: there was no choice
    std::size_t local_lights = 0;  ///< local lights of all tiles
};

/// How far the passes are.
struct PassRecord {
    /// Passes that have reached every row. There is always a range, whose seed and first pass are known
    /// before it has any pass.
    std::vector<PassRange> whole;
    uint begun_samples = 0;              ///< of the pass after them; 0 if that has reached no row
    uint begun_rows = 0;                 ///< rows that it has reached, less than all
    std::optional<PassChoice> choice{};  ///< empty until pass 0 is whole
    float close_fraction = 0.0f;         ///< of the first pass that was made
    PassTotals totals{};                 ///< of the whole passes
    PassPace pace{};
};

struct Checkpoint {
    PassRecord record;
    PassSums sums;
};

}  // namespace nearlight::core
