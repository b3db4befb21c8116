// SPDX-License-Identifier: Apache-2.0
// Order along the Morton curve, and the radix sort behind it. The kernels are in morton_sort.cl.
#pragma once

#include "host/base/math.h"
#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "host/stages/prefix_scan.h"
#include "host/stages/runs.h"
#include "kernels/shared/morton.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Sorts elements along the Morton curve. Elements are structs that begin with a position (Vec3, Vpl,
/// SurfaceSample, …).
class MortonSort {
  public:
    explicit MortonSort(Device& device);

    /// Writes the indices of the elements to `order`, along the Morton curve through their bounding box.
    /// Among equal codes, the lower index comes first. `order` must have room for `count` elements. Waits for
    /// the device.
    template <typename T>
    void order(const Buffer<T>& elements, std::size_t count, Buffer<uint>& order) {
        ensure_room(codes_, *device_, count);
        codes(elements, count, bounds(elements, count), codes_, order);
        sort(codes_, order, count);
    }

    /// The bounding box of the finite positions; it is empty if there are none. Waits for the device.
    template <typename T>
    Aabb bounds(const Buffer<T>& elements, std::size_t count) {
        const Runs runs = begin_bounds(count);
        bounds_.launch(runs.count, run_local_size(*device_), elements, boxes_, stride_of<T>(),
                       static_cast<uint>(count), runs.size, runs.count);
        return finish_bounds(runs.count);
    }
    /// Writes the 30-bit Morton codes of the positions, and values[i] = i. The cells are cubes, and 1024 of
    /// them span the longest side of the box. A position outside the box gets the code of the nearest cell.
    template <typename T>
    void codes(const Buffer<T>& elements, std::size_t count, const Aabb& box, Buffer<uint>& codes,
               Buffer<uint>& values) {
        const float longest = max_component(box.size());
        codes_kernel_.launch_items(count, elements, codes, values, stride_of<T>(), box.min.x, box.min.y,
                                   box.min.z, longest > 0.0f ? NEARLIGHT_MORTON_CELLS / longest : 0.0f,
                                   static_cast<uint>(count));
    }
    /// Sorts the first `count` pairs by key, in ascending order. Pairs of equal keys keep their order.
    void sort(Buffer<uint>& keys, Buffer<uint>& values, std::size_t count);

  private:
    template <typename T>
    static uint stride_of() {
        static_assert(sizeof(T) % sizeof(float) == 0 && sizeof(T) >= sizeof(Vec3));
        return static_cast<uint>(sizeof(T) / sizeof(float));
    }
    /// The runs of so many positions, for whose boxes it makes room.
    Runs begin_bounds(std::size_t count);
    Aabb finish_bounds(uint run_count) const;

    Device* device_;
    Program program_;
    Kernel bounds_;
    Kernel codes_kernel_;
    Kernel count_;
    Kernel scatter_;
    PrefixScan<uint> scan_;
    Buffer<Aabb> boxes_;  ///< bounding boxes of the runs
    Buffer<uint> codes_;
    Buffer<uint> other_keys_;
    Buffer<uint> other_values_;
    Buffer<uint> positions_;
};

}  // namespace nearlight::core
