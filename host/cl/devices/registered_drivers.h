// SPDX-License-Identifier: Apache-2.0
// The OpenCL drivers that are registered on this machine. The loader is silent about those that it cannot
// load.
#pragma once

#include <string>
#include <vector>

namespace nearlight::core {

/// Why drivers must not be loaded: the limit of open files is so low that they would end the process; and
/// what to do. Empty if it is high enough.
std::string too_few_files();

/// A line for each driver that is registered and cannot be loaded, with the reason. To be called when the
/// loader has loaded the others, which stay in memory.
std::vector<std::string> drivers_that_do_not_load();

}  // namespace nearlight::core
