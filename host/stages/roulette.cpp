// SPDX-License-Identifier: Apache-2.0
#include "host/stages/roulette.h"

#include <algorithm>

#include "host/base/division.h"

namespace nearlight::core {
namespace {

/// The memory for bounds, indices and weights together.
constexpr std::size_t kListBytes = std::size_t{96} << 20u;
constexpr std::size_t kEntryBytes = 2 * sizeof(float) + sizeof(uint);

/// The number of bundles whose lists fit into kListBytes together; at least 1.
std::size_t max_bundles(std::size_t vpl_count) {
    return std::max<std::size_t>(1, kListBytes / (kEntryBytes * std::max<std::size_t>(1, vpl_count)));
}

}  // namespace

Roulette::Roulette(Device& device)
    : device_(&device),
      program_(device, "roulette.cl"),
      bounds_kernel_(program_, "roulette_bounds"),
      choose_kernel_(program_, "roulette_choose"),
      whole_set_(device) {}

VplSelection Roulette::select(const RouletteTask& task) {
    const std::size_t max_length = strata_of(task).max_size(task.vpl_count);
    return {.max_bundles = max_bundles(max_length),
            .max_length = max_length,
            .lists = [this, task](std::size_t first_bundle, std::size_t end_bundle) -> const VplLists& {
                return choose(task, first_bundle, end_bundle);
            }};
}

const VplLists& Roulette::choose(const RouletteTask& task, std::size_t first_bundle, std::size_t end_bundle) {
    const std::size_t bundles = end_bundle - first_bundle;
    const VplStrata& strata = strata_of(task);
    const auto stride = static_cast<uint>(strata.max_size(task.vpl_count));
    const std::size_t entries = bundles * stride;
    ensure_room(bounds_, *device_, entries);
    ensure_room(lists_.vpls, *device_, entries);
    ensure_room(lists_.weights, *device_, entries);
    ensure_room(lists_.lengths, *device_, bundles);
    const auto vpl_count = static_cast<uint>(task.vpl_count);
    const auto packet_count = static_cast<uint>(task.packet_count);
    lists_.stride = stride;
    const auto first = lists_.first_bundle = static_cast<uint>(first_bundle);
    const auto end = static_cast<uint>(end_bundle);
    const uint run = device_->tunables().roulette_run;
    bounds_kernel_.launch_items(bundles * divide_rounding_up(stride, run), task.vpls, vpl_count, strata.count,
                                strata.of_bundles, strata.period, stride, run, task.receivers, packet_count,
                                first, end, task.clamp_radius * task.clamp_radius, bounds_);
    choose_kernel_.launch_items(bundles, bounds_, vpl_count, strata.count, strata.of_bundles, strata.period,
                                stride, task.receivers, packet_count, first, end, task.threshold, task.seed,
                                lists_.vpls, lists_.weights, lists_.lengths);
    return lists_;
}

}  // namespace nearlight::core
