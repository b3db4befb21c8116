// SPDX-License-Identifier: Apache-2.0
#include "host/stages/prefix_scan.h"

#include <type_traits>

#include "host/stages/chunks.h"

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
      scan_chunks_(program_, "scan_chunks"),
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
    const Chunks chunks = split_into_chunks(*device_, count);
    const std::size_t local_size = chunk_local_size(*device_);
    const auto scan_from = [&](const Buffer<T>& offsets) {
        scan_chunks_.launch(chunks.count, local_size, input, offsets, output, total_, count, chunks.size,
                            chunks.count, uint{inclusive});
    };
    if (chunks.count == 1) {
        scan_from(total_);  // a single run reads no offsets
        return;
    }
    if (chunk_sums_.size() <= level) {
        chunk_sums_.resize(level + 1);
    }
    // The sums are moved out of the vector because the deeper level may make it grow.
    Buffer<T> sums = std::move(chunk_sums_[level]);
    ensure_room(sums, *device_, chunks.count);
    reduce_.launch(chunks.count, local_size, input, sums, count, chunks.size, chunks.count);
    scan_level(sums, sums, chunks.count, false, level + 1);
    scan_from(sums);
    chunk_sums_[level] = std::move(sums);
}

template class PrefixScan<uint>;
template class PrefixScan<std::uint64_t>;

}  // namespace nearlight::core
