// SPDX-License-Identifier: Apache-2.0
// The layout of the structs that host and kernels share, as the host compiles them.
#pragma once

#include <string>
#include <vector>

namespace nearlight::core {

/// A size or a member's offset, bytes.
struct LayoutFact {
    std::string name;
    std::size_t value;
};

/// In the order in which kernels/layout_probe.cl writes what the device has.
std::vector<LayoutFact> shared_layout();

}  // namespace nearlight::core
