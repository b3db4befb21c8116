// SPDX-License-Identifier: Apache-2.0
// Memory in huge pages, for buffers of CPU devices that kernels read at random.
#pragma once

#include <CL/opencl.hpp>
#include <cstddef>

namespace nearlight::core {

/// The minimum size of a buffer in huge pages, in bytes. The driver allocates smaller ones.
inline constexpr std::size_t kMinHugeBytes = std::size_t{4} << 20;

/// Makes a buffer in memory for which the system was asked for huge pages. Returns a null handle if the
/// system gives none; the caller then asks the driver. The memory lives as long as OpenCL needs it. Throws
/// cl::Error.
cl::Buffer make_huge_buffer(const cl::Context& context, std::size_t bytes);

}  // namespace nearlight::core
