// SPDX-License-Identifier: Apache-2.0
// The layout of the structs and tables that host and kernels share, as the host compiles them.
#pragma once

#include <string>
#include <vector>

namespace nearlight::core {

/// The size of a struct or a member's offset, bytes; or the value of a shared constant or function.
struct LayoutFact {
    std::string name;
    std::size_t value;
};

/// In the order in which kernels/layout_probe.cl writes what the device has.
std::vector<LayoutFact> shared_layout();

}  // namespace nearlight::core
