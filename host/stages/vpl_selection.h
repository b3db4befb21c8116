// SPDX-License-Identifier: Apache-2.0
// Which VPLs of a set each bundle of receivers asks about, where it is not all of them. Russian roulette
// makes such selections (roulette.h); the gather only reads them.
#pragma once

#include <functional>

#include "host/base/receiver_bundles.h"
#include "host/cl/buffer.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// The lists of bundles [first_bundle, end). Entry k of a bundle, k < lengths[bundle − first_bundle], is at
/// (bundle − first_bundle)·stride + k of `vpls` (an index, ascending) and of `weights` (what the VPL counts).
struct VplLists {
    Buffer<uint> vpls;
    Buffer<float> weights;
    Buffer<uint> lengths;
    uint first_bundle = 0;
    uint stride = 0;
};

struct VplSelection {
    BundleLayout bundles;         ///< of the receivers that ask
    std::size_t max_bundles = 1;  ///< whose lists are made at a time
    /// The lists of bundles [first_bundle, end_bundle), at most max_bundles; valid until the next call.
    std::function<const VplLists&(std::size_t first_bundle, std::size_t end_bundle)> lists;
};

}  // namespace nearlight::core
