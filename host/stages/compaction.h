// SPDX-License-Identifier: Apache-2.0
// Keeps the elements whose flag is set, in their order. The kernels are in compaction.cl.
#pragma once

#include <vector>

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "host/stages/prefix_scan.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

class Compaction {
  public:
    explicit Compaction(Device& device);

    /// Writes the indices i < count of the flags that are not 0 to `indices`, in ascending order, and returns
    /// how many there are. `indices` must have room for them; `count` elements always suffice. Waits for the
    /// device.
    std::size_t list_set(const Buffer<uint>& flags, std::size_t count, Buffer<uint>& indices);

    /// Sets gathered[i] = elements[indices[i]] for all i < count.
    template <typename T>
    void gather(const Buffer<T>& elements, const Buffer<uint>& indices, std::size_t count,
                Buffer<T>& gathered) {
        static_assert(sizeof(T) % sizeof(uint) == 0, "elements are moved in words of 4 bytes");
        gather_.launch_items(count, elements, indices, gathered, static_cast<uint>(sizeof(T) / sizeof(uint)),
                             static_cast<uint>(count));
    }

    /// Returns the elements, of the first `count`, whose flags are not 0, in their order. Waits for the
    /// device.
    template <typename T>
    std::vector<T> download_set(const Buffer<T>& elements, const Buffer<uint>& flags, std::size_t count) {
        Buffer<uint> indices(*device_, count);
        std::vector<T> result(list_set(flags, count, indices));
        Buffer<T> kept(*device_, result.size());
        gather(elements, indices, result.size(), kept);
        kept.download(result);
        return result;
    }

  private:
    Device* device_;
    Program program_;
    Kernel count_;
    Kernel write_;
    Kernel gather_;
    PrefixScan<uint> scan_;
    Buffer<uint> run_counts_;
};

}  // namespace nearlight::core
