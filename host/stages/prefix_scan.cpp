// SPDX-License-Identifier: Apache-2.0
#include "host/stages/prefix_scan.h"

#include <type_traits>

#include "host/stages/runs.h"

namespace nearlight::core {
namespace {

template <typename T>
const char* kernel_type() {
    static_assert(std::is_same_v<T, uint> || std::is_same_v<T, std::uint64_t>);
    return std::is_same_v<T, uint> ? "uint" : "ulong";
}

}  // namespace

template <typename T>
PrefixScan<T>::PrefixScan(Device& device)
    : device_(&device),
      program_(device, "prefix_scan.cl", {{"SCAN_TYPE", kernel_type<T>()}}),
      reduce_(program_, "scan_reduce"),
      scan_runs_(program_, "scan_runs"),
      total_(device, 1) {
    total_.fill_zero();
}

template <typename T>
void PrefixScan<T>::scan(const Buffer<T>& input, Buffer<T>& output, std::size_t count, bool inclusive) {
    if (count == 0) {
        total_.fill_zero();
        return;
    }
    scan_level(input, output, to_kernel_count(count, "elements to sum"), inclusive, 0);
}

template <typename T>
void PrefixScan<T>::scan_level(const Buffer<T>& input, Buffer<T>& output, uint count, bool inclusive,
                               std::size_t level) {
    const Runs runs = split_into_runs(*device_, count);
    const std::size_t local_size = run_local_size(*device_);
    const auto scan_from = [&](const Buffer<T>& offsets) {
        scan_runs_.launch(runs.count, local_size, input, offsets, output, total_, count, runs.size,
                          runs.count, uint{inclusive});
    };
    if (runs.count == 1) {
        scan_from(total_);  // a single run reads no offsets
        return;
    }
    if (run_sums_.size() <= level) {
        run_sums_.resize(level + 1);
    }
    // The sums are moved out of the vector because the deeper level may make it grow.
    Buffer<T> sums = std::move(run_sums_[level]);
    ensure_room(sums, *device_, runs.count);
    reduce_.launch(runs.count, local_size, input, sums, count, runs.size, runs.count);
    scan_level(sums, sums, runs.count, false, level + 1);
    scan_from(sums);
    run_sums_[level] = std::move(sums);
}

template class PrefixScan<uint>;
template class PrefixScan<std::uint64_t>;

}  // namespace nearlight::core
