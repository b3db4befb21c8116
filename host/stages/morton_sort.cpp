// SPDX-License-Identifier: Apache-2.0
#include "host/stages/morton_sort.h"

#include "host/stages/joint_programs.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kDigitCount = 256;
constexpr uint kDigitBits = 8;
constexpr uint kKeyBits = 32;
static_assert(kKeyBits / kDigitBits % 2 == 0, "an even number of passes ends in the buffers it began with");
static_assert(sizeof(Aabb) == 6 * sizeof(float));

/// Splits pairs into runs that are long enough to be worth their 256 counters.
Runs split_for_sort(const Device& device, std::size_t count) {
    return split_into_runs(device, count, device.tunables().shortest_sort_run);
}

}  // namespace

MortonSort::MortonSort(Device& device)
    : device_(&device),
      program_(device, "morton_sort.cl", kVplsProgram),
      bounds_(program_, "morton_bounds"),
      codes_kernel_(program_, "morton_codes"),
      count_(program_, "sort_count"),
      scatter_(program_, "sort_scatter"),
      scan_(device) {}

Runs MortonSort::begin_bounds(std::size_t count) {
    to_kernel_count(count, "points");
    const Runs runs = split_into_runs(*device_, count);
    ensure_room(boxes_, *device_, std::max(runs.count, 1u));
    return runs;
}

Aabb MortonSort::finish_bounds(uint run_count) const {
    std::vector<Aabb> boxes(run_count);
    boxes_.download(boxes);
    Aabb box;
    for (const Aabb& part : boxes) {
        box.extend(part);
    }
    return box;
}

void MortonSort::sort(Buffer<uint>& keys, Buffer<uint>& values, std::size_t count) {
    if (count < 2) {
        return;
    }
    const uint n = to_kernel_count(count, "keys");
    const Runs runs = split_for_sort(*device_, count);
    const std::size_t local_size = run_local_size(*device_);
    const std::size_t position_count = kDigitCount * runs.count;
    ensure_room(other_keys_, *device_, count);
    ensure_room(other_values_, *device_, count);
    ensure_room(positions_, *device_, position_count);

    const auto pass = [&](const Buffer<uint>& from_keys, const Buffer<uint>& from_values,
                          Buffer<uint>& to_keys, Buffer<uint>& to_values, uint shift) {
        count_.launch(runs.count, local_size, from_keys, positions_, shift, n, runs.size, runs.count);
        scan_.exclusive(positions_, positions_, position_count);
        scatter_.launch(runs.count, local_size, from_keys, from_values, positions_, to_keys, to_values, shift,
                        n, runs.size, runs.count);
    };
    for (uint shift = 0; shift < kKeyBits; shift += 2 * kDigitBits) {
        pass(keys, values, other_keys_, other_values_, shift);
        pass(other_keys_, other_values_, keys, values, shift + kDigitBits);
    }
}

}  // namespace nearlight::core
