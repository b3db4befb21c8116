// SPDX-License-Identifier: Apache-2.0
// Local memory of kernels whose work-groups each take a bundle of receivers (kernels/lib/bundle_light.cl).
#pragma once

#include "host/base/receiver_bundles.h"
#include "host/cl/kernel.h"

namespace nearlight::core {

/// What one light brings to each receiver of a bundle, in the order of BUNDLE_LIGHT_PARAMETERS.
struct BundleLight {
    static constexpr LocalMemory irradiance{kBundleReceivers * 4 *
                                            sizeof(float)};  ///< a float3 has the size of four floats
    static constexpr LocalMemory geometry{kBundleReceivers * sizeof(float)};
    static constexpr LocalMemory density{kBundleReceivers * sizeof(float)};

    template <typename Visitor>
    void for_each_buffer(Visitor&& visit) const {
        visit(irradiance);
        visit(geometry);
        visit(density);
    }
};

}  // namespace nearlight::core
