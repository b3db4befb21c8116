// SPDX-License-Identifier: Apache-2.0
// Memory in huge pages, for buffers of CPU devices that are read all over.
#pragma once

#include <CL/opencl.hpp>
#include <cstddef>

namespace nearlight::core {

/// Below this size a buffer is left to the driver.
inline constexpr std::size_t kMinHugeBytes = std::size_t{4} << 20;

/// A buffer of the context in memory for which the system was asked for huge pages; a null handle where it
/// has none to give, so that the caller asks the driver. The memory lives as long as OpenCL needs it. Throws
/// cl::Error.
cl::Buffer make_huge_buffer(const cl::Context& context, std::size_t bytes);

}  // namespace nearlight::core
