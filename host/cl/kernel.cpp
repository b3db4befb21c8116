// SPDX-License-Identifier: Apache-2.0
#include "host/cl/kernel.h"

#include <algorithm>
#include <bit>

#include "host/base/division.h"
#include "host/base/stopwatch.h"

namespace nearlight::core {

std::string Kernel::description() const {
    return "kernel " + name_ + " on device " + program_.device().name();
}

void Kernel::open() {
    cl::Kernel handle = program_.kernel(name_);
    max_local_size_ = with_opencl_errors(description(), [&] {
        return handle.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(program_.device().entry().handle);
    });
    handle_ = std::move(handle);
}

std::size_t Kernel::fitting(std::size_t local_size) const {
    return std::min(local_size, std::bit_floor(std::max<std::size_t>(max_local_size_, 1)));
}

void Kernel::enqueue(Items items, std::size_t local_size) {
    Device& device = program_.device();
    with_opencl_errors(description(), [&] {
        cl::Event event;
        device.queue().enqueueNDRangeKernel(*handle_, cl::NDRange(items.first),
                                            cl::NDRange(round_up_to_multiple(items.count, local_size)),
                                            cl::NDRange(local_size), nullptr, &event);
        device.profiler().record(name_, std::move(event));
    });
}

/// Drivers of GPUs stop kernels that run for seconds. Each part has as many work-items as take
/// Tunables::launch_ms at the pace of the part before it, but at most four times as many as that had, because
/// neighbouring parts may differ in cost.
void Kernel::enqueue_parts(std::size_t item_count, std::size_t local_size) {
    Device& device = program_.device();
    const Tunables& tunables = device.tunables();
    if (item_count <= tunables.launch_items) {
        enqueue({0, item_count}, local_size);
        return;
    }
    part_items_ = part_items_ == 0 ? tunables.launch_items : part_items_;
    device.finish();  // what was sent before must not count as time of the first part
    for (std::size_t first = 0; first < item_count;) {
        const std::size_t whole = round_up_to_multiple(part_items_, local_size);
        const std::size_t count = std::min(item_count - first, whole);
        const Stopwatch watch;
        enqueue({first, count}, local_size);
        device.finish();
        if (count == whole) {  // the last part may be too small to show the pace
            const double fit =
                1e-3 * tunables.launch_ms * static_cast<double>(whole) / std::max(1e-6, watch.seconds());
            part_items_ = static_cast<std::size_t>(std::clamp(fit, 1.0, 4.0 * static_cast<double>(whole)));
        }
        first += count;
    }
}

}  // namespace nearlight::core
