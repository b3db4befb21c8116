// SPDX-License-Identifier: Apache-2.0
// How kernels that give each work-item a run of elements split an array (see kernels/lib/chunk.cl).
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "host/cl/device.h"
#include "kernels/shared/types.h"
#include "nearlight/error.h"

namespace nearlight::core {

/// `count` runs of `size` elements each, the last one perhaps shorter, none empty.
struct Chunks {
    uint size = 0;
    uint count = 0;
};

/// About one run a worker of the device, but none of fewer than `shortest` elements.
inline Chunks split_into_chunks(const Device& device, std::size_t element_count, std::size_t shortest) {
    const std::size_t even = (element_count + device.worker_count() - 1) / device.worker_count();
    const std::size_t size = std::max(shortest, even);
    return {static_cast<uint>(size), static_cast<uint>((element_count + size - 1) / size)};
}
/// With runs that are worth a work-item where an element is little work.
inline Chunks split_into_chunks(const Device& device, std::size_t element_count) {
    return split_into_chunks(device, element_count, device.tunables().shortest_run);
}

/// Work-group size for such kernels.
inline std::size_t chunk_local_size(const Device& device) {
    return device.tunables().run_local_size;
}

/// Kernels count in 32 bits. Throws Error(ErrorKind::out_of_memory) beyond them.
inline uint to_kernel_count(std::size_t count, const char* what) {
    if (count > UINT32_MAX) {
        throw Error(ErrorKind::out_of_memory, std::to_string(count) + " " + what +
                                                  " are more than the 2^32 - 1 that kernels can count; use "
                                                  "fewer");
    }
    return static_cast<uint>(count);
}

}  // namespace nearlight::core
