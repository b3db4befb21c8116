// SPDX-License-Identifier: Apache-2.0
// Prefix sums of integers on the device; the same result on every device. Kernels: prefix_scan.cl.
#pragma once

#include <cstdint>
#include <vector>

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// T is uint or std::uint64_t. Sums wrap around as unsigned integers do; the caller sees to it that they fit.
template <typename T>
class PrefixScan {
  public:
    explicit PrefixScan(Device& device);

    /// output[i] = input[0] + … + input[i − 1], for i < count. Both hold at least `count` elements; they may
    /// be one buffer.
    void exclusive(const Buffer<T>& input, Buffer<T>& output, std::size_t count) {
        scan(input, output, count, false);
    }
    /// output[i] = input[0] + … + input[i].
    void inclusive(const Buffer<T>& input, Buffer<T>& output, std::size_t count) {
        scan(input, output, count, true);
    }
    /// One element: the sum of all inputs of the latest scan.
    [[nodiscard]] const Buffer<T>& total() const { return total_; }

    /// Device memory that a scan of `count` elements keeps for itself.
    [[nodiscard]] std::size_t scratch_bytes(std::size_t count) const;

  private:
    void scan(const Buffer<T>& input, Buffer<T>& output, std::size_t count, bool inclusive);
    void scan_level(const Buffer<T>& input, Buffer<T>& output, uint count, bool inclusive, std::size_t level);

    Device* device_;
    Program program_;
    Kernel reduce_;
    Kernel scan_chunks_;
    Buffer<T> total_;
    std::vector<Buffer<T>> chunk_sums_;  ///< by level
};

extern template class PrefixScan<uint>;
extern template class PrefixScan<std::uint64_t>;

}  // namespace nearlight::core
