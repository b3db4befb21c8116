// SPDX-License-Identifier: Apache-2.0
// The layout of the structs and tables that host and kernels share, as the host compiles them.
#pragma once

#include <string>
#include <vector>

namespace nearlight::core {

/// The size of a struct or the offset of a member, in bytes, or the value of a shared constant or function.
struct LayoutFact {
    std::string name;
    std::size_t value;
};

/// The layout on the host, in the order in which kernels/layout_probe.cl writes that of the device.
std::vector<LayoutFact> shared_layout();

}  // namespace nearlight::core
