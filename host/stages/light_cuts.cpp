// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_cuts.h"

#include <algorithm>
#include <cmath>

#include "host/base/division.h"
#include "host/base/random.h"

namespace nearlight::core {
namespace {

/// The memory for cuts and lists together.
constexpr std::size_t kCutBytes = std::size_t{96} << 20u;
/// The maximum number of entries of a cut, for each VPL that is asked and in all. A cut that would need more
/// opens fewer nodes, which makes its draws noisier.
constexpr std::size_t kEntriesPerVpl = 16;
constexpr std::size_t kMinEntries = 512;
constexpr std::size_t kMaxEntries = std::size_t{1} << 20u;
constexpr uint kShiftStream = 0xc0751f7u;

/// The number of VPLs that a bundle asks about.
double asked_by_bundle(const CutTask& task) {
    return static_cast<double>(task.asked_count) / task.strata.count;
}
std::size_t capacity_of(const CutTask& task) {
    return std::clamp(kEntriesPerVpl * static_cast<std::size_t>(std::ceil(asked_by_bundle(task))),
                      kMinEntries, kMaxEntries);
}
/// The length of the longest list. Systematic draws make one more than asked at most; a few more are room for
/// the minimum probabilities of entries.
std::size_t stride_of(const CutTask& task) {
    return static_cast<std::size_t>(std::ceil(asked_by_bundle(task))) + 4;
}
std::size_t max_bundles(const CutTask& task) {
    const std::size_t bytes =
        2 * capacity_of(task) * sizeof(CutEntry) + stride_of(task) * (sizeof(uint) + sizeof(float));
    return std::max<std::size_t>(1, kCutBytes / bytes);
}

}  // namespace

LightCuts::LightCuts(Device& device)
    : device_(&device),
      program_(device, "light_cuts.cl"),
      leaves_kernel_(program_, "cut_leaves"),
      level_kernel_(program_, "cut_level"),
      choose_kernel_(program_, "cut_choose"),
      params_(device, 1) {}

CutTree LightCuts::make_tree(const Buffer<Vpl>& vpls, std::size_t vpl_count) {
    CutTree tree;
    tree.first_nodes.push_back(0);
    std::size_t size = vpl_count;
    do {
        size = divide_rounding_up(size, NEARLIGHT_CUT_FANOUT);
        tree.first_nodes.push_back(tree.first_nodes.back() + static_cast<uint>(size));
    } while (size > NEARLIGHT_CUT_MAX_ROOTS);
    tree.nodes = Buffer<CutNode>(*device_, tree.first_nodes.back());
    leaves_kernel_.launch_items(tree.leaf_count(), vpls, static_cast<uint>(vpl_count), tree.nodes,
                                tree.leaf_count());
    for (std::size_t level = 1; level + 1 < tree.first_nodes.size(); ++level) {
        const uint below = tree.first_nodes[level - 1];
        const uint first = tree.first_nodes[level];
        const uint count = tree.first_nodes[level + 1] - first;
        level_kernel_.launch_items(count, tree.nodes, below, first - below, first, count);
    }
    return tree;
}

VplSelection LightCuts::select(const CutTask& task) {
    return {.max_bundles = max_bundles(task),
            .max_length = stride_of(task),
            .lists = [this, task](std::size_t first_bundle, std::size_t end_bundle) -> const VplLists& {
                return choose(task, first_bundle, end_bundle);
            }};
}

const VplLists& LightCuts::choose(const CutTask& task, std::size_t first_bundle, std::size_t end_bundle) {
    const std::size_t bundles = end_bundle - first_bundle;
    const std::size_t capacity = capacity_of(task);
    const std::size_t stride = stride_of(task);
    ensure_room(entries_, *device_, bundles * 2 * capacity);
    ensure_room(lists_.vpls, *device_, bundles * stride);
    ensure_room(lists_.weights, *device_, bundles * stride);
    ensure_room(lists_.lengths, *device_, bundles);
    lists_.first_bundle = static_cast<uint>(first_bundle);
    lists_.stride = static_cast<uint>(stride);
    const CutParams params{.first_root = task.tree.first_root(),
                           .root_count = task.tree.root_count(),
                           .leaf_count = task.tree.leaf_count(),
                           .packet_count = static_cast<uint>(task.packet_count),
                           .first_bundle = lists_.first_bundle,
                           .end_bundle = static_cast<uint>(end_bundle),
                           .strata = task.strata.count,
                           .stratum_period = task.strata.period,
                           .capacity = static_cast<uint>(capacity),
                           .list_stride = lists_.stride,
                           .asked = static_cast<float>(asked_by_bundle(task)),
                           .shift = static_cast<float>(Pcg32(task.seed, kShiftStream).uniform()),
                           .clamp_radius_squared = task.clamp_radius * task.clamp_radius,
                           .pad0 = 0,
                           .pad1 = 0,
                           .pad2 = 0};
    params_.upload(std::span(&params, 1));
    choose_kernel_.launch_items(bundles, task.vpls, task.tree.nodes, task.receivers, task.strata.of_bundles,
                                params_, entries_, lists_.vpls, lists_.weights, lists_.lengths);
    return lists_;
}

}  // namespace nearlight::core
