// SPDX-License-Identifier: Apache-2.0
// Array sizes at which parallel primitives tend to break.
#pragma once

#include <cstddef>
#include <vector>

namespace nearlight::core::test {

/// The sizes 0 and 1, sizes around those of work-groups and around the lengths at which arrays are split, and
/// one large size.
inline std::vector<std::size_t> awkward_sizes() {
    std::vector<std::size_t> sizes{0, 1, 2, 3};
    for (const std::size_t size : {8, 32, 64, 256, 1024, 4096, 8192, 65536, 262144}) {
        sizes.insert(sizes.end(), {size - 1, size, size + 1});
    }
    sizes.push_back(10'000'000);
    return sizes;
}

}  // namespace nearlight::core::test
