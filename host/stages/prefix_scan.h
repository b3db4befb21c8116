// SPDX-License-Identifier: Apache-2.0
// Prefix sums of integers, with the same result on every device. The kernels are in prefix_scan.cl.
#pragma once

#include <cstdint>
#include <vector>

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Prefix sums of T, which is uint or std::uint64_t. Sums wrap around as unsigned integers do; the caller
/// makes sure that they fit.
template <typename T>
class PrefixScan {
  public:
    explicit PrefixScan(Device& device);

    /// Sets output[i] = input[0] + … + input[i − 1] for all i < count. Both buffers hold at least `count`
    /// elements, and they may be the same buffer.
    void exclusive(const Buffer<T>& input, Buffer<T>& output, std::size_t count) {
        scan(input, output, count, false);
    }
    /// Sets output[i] = input[0] + … + input[i] for all i < count. They may be one buffer.
    void inclusive(const Buffer<T>& input, Buffer<T>& output, std::size_t count) {
        scan(input, output, count, true);
    }
    /// A buffer of one element: the sum of all inputs of the latest scan.
    [[nodiscard]] const Buffer<T>& total() const { return total_; }

  private:
    void scan(const Buffer<T>& input, Buffer<T>& output, std::size_t count, bool inclusive);
    void scan_level(const Buffer<T>& input, Buffer<T>& output, uint count, bool inclusive, std::size_t level);

    Device* device_;
    Program program_;
    Kernel reduce_;
    Kernel scan_runs_;
    Buffer<T> total_;
    std::vector<Buffer<T>> run_sums_;  ///< one buffer per level
};

extern template class PrefixScan<uint>;
extern template class PrefixScan<std::uint64_t>;

}  // namespace nearlight::core
