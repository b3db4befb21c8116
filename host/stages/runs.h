// SPDX-License-Identifier: Apache-2.0
// How an array is split for kernels that give each work-item a run of elements (kernels/lib/run.cl).
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "host/base/division.h"
#include "host/cl/device.h"
#include "kernels/shared/types.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// An array split into `count` runs of `size` elements. The last run may be shorter, but no run is empty.
struct Runs {
    uint size = 0;
    uint count = 0;
};

/// Splits an array into about one run per worker of the device; all runs but the last have at least
/// `min_size` elements.
inline Runs split_into_runs(const Device& device, std::size_t element_count, std::size_t min_size) {
    const std::size_t even = divide_rounding_up(element_count, device.worker_count());
    const std::size_t size = std::max(min_size, even);
    return {static_cast<uint>(size), static_cast<uint>(divide_rounding_up(element_count, size))};
}
/// Splits an array whose elements are little work each into runs that are worth a work-item.
inline Runs split_into_runs(const Device& device, std::size_t element_count) {
    return split_into_runs(device, element_count, device.tunables().shortest_run);
}

/// The work-group size for kernels that give each work-item a run of elements.
inline std::size_t run_local_size(const Device& device) {
    return device.tunables().run_local_size;
}

/// Converts a count to the 32 bits that kernels use. Throws Error(ErrorKind::out_of_memory) if it is larger;
/// `what` names the elements.
inline uint to_kernel_count(std::size_t count, const char* what) {
    if (count > UINT32_MAX) {
        throw Error(ErrorKind::out_of_memory, std::to_string(count) + " " + what +
                                                  " are more than the 2^32 - 1 that kernels can count; use "
                                                  "fewer");
    }
    return static_cast<uint>(count);
}

}  // namespace nearlight::core
