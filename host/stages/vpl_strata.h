// SPDX-License-Identifier: Apache-2.0
// The strata of a set of VPLs. A stratum is every count-th VPL of the set in its order, so that one bundle of
// receivers asks about a small, even part of the set.
#pragma once

#include <cstddef>
#include <span>

#include "host/base/division.h"
#include "host/cl/buffer.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Which stratum each bundle asks about. Each VPL of it counts as often as there are strata, so that a bundle
/// has the light of the whole set in expectation if its stratum is drawn with equal probabilities.
struct VplStrata {
    /// A single stratum, which is the whole set.
    explicit VplStrata(Device& device) : of_bundles(device, std::size_t{0}) {}
    /// `stratum_count` strata; bundle i asks about stratum strata[i % strata.size()].
    VplStrata(Device& device, uint stratum_count, std::span<const uint> strata)
        : count(stratum_count), period(static_cast<uint>(strata.size())), of_bundles(device, strata) {}

    /// The number of VPLs of a set of `vpl_count` that are in its largest stratum.
    [[nodiscard]] std::size_t max_size(std::size_t vpl_count) const {
        return divide_rounding_up(vpl_count, count);
    }

    uint count = 1;           ///< number of strata
    uint period = 1;          ///< bundles after which their strata repeat
    Buffer<uint> of_bundles;  ///< strata of the first `period` bundles; empty if there is only one
};

}  // namespace nearlight::core
