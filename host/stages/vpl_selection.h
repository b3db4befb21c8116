// SPDX-License-Identifier: Apache-2.0
// The VPLs of a set that each bundle of receivers asks about, where these are not all VPLs. Russian roulette
// (roulette.h) and cuts (light_cuts.h) make such selections; the gather only reads them.
#pragma once

#include <functional>

#include "host/base/receiver_bundles.h"
#include "host/cl/buffer.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// The lists of consecutive bundles, from first_bundle on. Entry k of a bundle, k < lengths[bundle −
/// first_bundle], is element (bundle − first_bundle)·stride + k of `vpls`, which holds ascending indices, and
/// of `weights`, the factor for the VPL's light.
struct VplLists {
    Buffer<uint> vpls;
    Buffer<float> weights;
    Buffer<uint> lengths;
    uint first_bundle = 0;
    uint stride = 0;
};

struct VplSelection {
    std::size_t max_bundles = 1;  ///< maximum number of bundles in a call of `lists`
    std::size_t max_length = 0;   ///< maximum number of VPLs in a list
    /// Returns the lists of bundles [first_bundle, end_bundle), at most max_bundles of them. They are valid
    /// until the next call.
    std::function<const VplLists&(std::size_t first_bundle, std::size_t end_bundle)> lists;
};

}  // namespace nearlight::core
