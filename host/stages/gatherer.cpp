// SPDX-License-Identifier: Apache-2.0
#include "host/stages/gatherer.h"

#include <algorithm>
#include <bit>

#include "host/base/receiver_bundles.h"
#include "host/base/stopwatch.h"

namespace nearlight::core {
namespace {

/// The number of VPLs that are summed by themselves before their sum is added to the irradiance, if there are
/// no groups. Launches end at multiples of it.
constexpr std::size_t kChunk = 256;

template <typename Source>
std::size_t chunk_of(const GatherInput<Source>& input) {
    return input.group_size != 0 ? input.group_size : kChunk;
}

/// The maximum number of pairs in a launch, however fast the device is.
constexpr double kMaxLaunchPairs = 0x1p40;

GatherConfig resolved(GatherConfig config, const Device& device) {
    config.kernel = choose_kernel(config.kernel, device);
    if (config.beam_width == 0) {
        config.beam_width = device.tunables().beam_width;
    }
    if (config.launch_seconds == 0.0) {
        config.launch_seconds = 1e-3 * device.tunables().launch_ms;
    }
    if (config.beam_width < 16 || config.beam_width > 256 || !std::has_single_bit(config.beam_width)) {
        throw Error(ErrorKind::invalid_argument, "a gather beam has 16, 32, 64, 128 or 256 lanes, not " +
                                                     std::to_string(config.beam_width));
    }
    return config;
}

}  // namespace

/// The work of one launch: bundles [first_bundle, end_bundle) with VPLs [first_vpl, end_vpl).
struct Gatherer::Part {
    std::size_t first_bundle = 0;
    std::size_t end_bundle = 0;
    std::size_t first_vpl = 0;
    std::size_t end_vpl = 0;

    [[nodiscard]] std::uint64_t pairs(const BundleLayout& layout) const {
        std::uint64_t packets = 0;
        for (std::size_t i = first_bundle; i < end_bundle; ++i) {
            packets += layout.bundle(static_cast<uint>(i)).count;
        }
        return packets * (end_vpl - first_vpl) * NEARLIGHT_PACKET_SIZE;
    }
};

/// How far a gather has come.
struct Gatherer::Course {
    const GatherProgress& progress;
    std::uint64_t total;  ///< pairs
    double budget;        ///< maximum pairs in the next launch
    std::uint64_t done = 0;
};

Gatherer::Gatherer(Device& device, const GatherConfig& config)
    : device_(&device),
      config_(resolved(config, device)),
      launch_pairs_(std::clamp(static_cast<double>(config_.first_launch_pairs), 1.0, kMaxLaunchPairs)),
      params_(device, 1),
      next_beam_(device, 1),
      no_numbers_(device, 0),
      whole_set_(device) {
    kernel_of(false, false);
}

Kernel& Gatherer::kernel_of(bool lists, bool recording) {
    std::optional<Kernel>& kernel = kernels_[(lists ? 2 : 0) + (recording ? 1 : 0)];
    if (!kernel) {
        kernel = make_kernel(lists, recording);
    }
    return *kernel;
}

Kernel Gatherer::make_kernel(bool lists, bool recording) const {
    Defines defines{{"GATHER_CHUNK", std::to_string(kChunk)}};
    if (lists) {
        defines.emplace("GATHER_LISTS", "1");
    }
    if (recording) {
        defines.emplace("GATHER_RECORD", "1");
    }
    if (config_.kernel == GatherKernel::rays) {
        return {Program(*device_, "gather_rays.cl", defines), "gather_rays"};
    }
    defines.emplace("GATHER_BEAM_WIDTH", std::to_string(config_.beam_width));
    return {Program(*device_, "gather_packets.cl", defines), "gather_packets"};
}

/// Returns the part after `done`: the same bundles with further VPLs, or further bundles when all VPLs are
/// done.
template <typename Source>
Gatherer::Part Gatherer::next_part(const GatherInput<Source>& input, const Part& done, std::size_t end_bundle,
                                   std::uint64_t pair_budget) const {
    const std::uint64_t chunk = chunk_of(input);
    const std::uint64_t chunk_pairs = chunk * std::uint64_t{kBundleReceivers};
    Part part = done;
    if (done.end_vpl >= input.asked_count()) {
        const std::size_t bundles =
            std::clamp<std::uint64_t>(pair_budget / chunk_pairs, 1, device_->tunables().launch_bundles);
        part.first_bundle = done.end_bundle;
        part.end_bundle = std::min(end_bundle, part.first_bundle + bundles);
        part.end_vpl = 0;
    }
    const std::uint64_t chunks = pair_budget / (chunk_pairs * (part.end_bundle - part.first_bundle));
    part.first_vpl = part.end_vpl;
    part.end_vpl = std::min<std::uint64_t>(
        input.asked_count(), part.first_vpl + chunk * std::clamp<std::uint64_t>(chunks, 1, 1u << 20u));
    return part;
}

/// Launches the kernel for one part. If `lists` is null, all bundles ask about all VPLs of their strata.
template <typename Source, typename... More>
void Gatherer::launch(Kernel& kernel, const GatherInput<Source>& input, const Part& part,
                      const VplLists* lists, GatherSums<Source>& sums, const More&... more) {
    const BundleLayout layout = input.bundles();
    const GatherParams params{.first_vpl = static_cast<uint>(part.first_vpl),
                              .end_vpl = static_cast<uint>(part.end_vpl),
                              .vpl_count = static_cast<uint>(input.vpl_count),
                              .packet_count = layout.packet_count,
                              .first_bundle = static_cast<uint>(part.first_bundle),
                              .end_bundle = static_cast<uint>(part.end_bundle),
                              .clamp_radius_squared = input.clamp_radius * input.clamp_radius,
                              .group_size = input.group_size,
                              .has_thresholds = input.thresholds != nullptr ? 1u : 0u,
                              .first_listed_bundle = lists != nullptr ? lists->first_bundle : 0,
                              .list_stride = lists != nullptr ? lists->stride : 0,
                              .has_curves = input.curves != nullptr ? 1u : 0u,
                              .has_maps = input.has_maps ? 1u : 0u,
                              .strata = strata_of(input).count,
                              .stratum_period = strata_of(input).period,
                              .pad0 = 0};
    params_.upload(std::span(&params, 1));
    if (lists != nullptr) {
        launch_with(kernel, input, part, sums, lists->vpls, lists->weights, lists->lengths, more...);
    } else {
        launch_with(kernel, input, part, sums, more...);
    }
}

template <typename Source, typename... More>
void Gatherer::launch_with(Kernel& kernel, const GatherInput<Source>& input, const Part& part,
                           GatherSums<Source>& sums, const More&... more) {
    const std::size_t receivers = (part.end_bundle - part.first_bundle) * std::uint64_t{kBundleReceivers};
    const auto launch_on = [&](std::size_t items, std::size_t local_size, const auto& nodes,
                               const auto& triangles, const auto&... rest) {
        kernel.launch(items, local_size, nodes, triangles, input.vpls, input.receivers, params_,
                      input.thresholds != nullptr ? *input.thresholds : no_numbers_,
                      input.curves != nullptr ? *input.curves : no_numbers_, strata_of(input).of_bundles,
                      input.group_size == 0 ? sums.light : sums.squares, sums.groups, rest...);
    };
    if (config_.kernel == GatherKernel::rays) {
        launch_on(receivers, device_->tunables().local_size, input.tree.nodes, input.tree.triangles, more...);
    } else {
        next_beam_.fill_zero();
        launch_on(receivers / config_.beam_width, 1, input.tree.wide_nodes, input.tree.blocks, next_beam_,
                  more...);
    }
}

/// Gathers for bundles [first_bundle, end_bundle), launch by launch. Returns false if cancelled.
template <typename Source>
bool Gatherer::gather_bundles(Kernel& kernel, const GatherInput<Source>& input, std::size_t first_bundle,
                              std::size_t end_bundle, const VplLists* lists, GatherSums<Source>& sums,
                              Course& course) {
    Part part;
    part.end_bundle = first_bundle;
    part.end_vpl = input.asked_count();
    device_->finish();  // what was sent before must not count as time of the first launch
    while (part.end_bundle < end_bundle || part.end_vpl < input.asked_count()) {
        part = next_part(input, part, end_bundle, static_cast<std::uint64_t>(course.budget));
        const Stopwatch watch;
        launch(kernel, input, part, lists, sums);
        device_->finish();
        // The budget grows at most fourfold per launch, because neighbouring parts may differ in cost.
        const std::uint64_t pairs = part.pairs(input.bundles());
        const double fitting =
            static_cast<double>(pairs) * config_.launch_seconds / std::max(1e-6, watch.seconds());
        course.budget = std::clamp(fitting, 1.0, std::min(course.budget * 4.0, kMaxLaunchPairs));
        course.done += pairs;
        if (course.progress && !course.progress(course.done, course.total)) {
            return false;
        }
    }
    return true;
}

/// Calls work(kernel, first_bundle, end_bundle, lists or null) for all bundles in turn, in runs of as many
/// bundles as the selection makes lists for. Returns false as soon as `work` does.
template <typename Source, typename Work>
bool Gatherer::for_each_run(const GatherInput<Source>& input, bool recording, const Work& work) {
    const bool has_tree =
        config_.kernel == GatherKernel::packets ? input.tree.is_wide() : input.tree.nodes.count() > 0;
    if (!has_tree) {
        throw Error(ErrorKind::failure, "this gather needs another tree: upload the tree for its kernel");
    }
    if ((input.selection != nullptr || input.strata != nullptr) && input.group_size != 0) {
        throw Error(ErrorKind::invalid_argument,
                    "a gather that sums by groups takes neither strata nor a selection of VPLs");
    }
    const std::size_t bundle_count = input.bundles().bundle_count();
    Kernel& kernel = kernel_of(input.selection != nullptr, recording);
    if (input.selection == nullptr) {
        return work(kernel, 0, bundle_count, nullptr);
    }
    for (std::size_t first = 0; first < bundle_count; first += input.selection->max_bundles) {
        const std::size_t end = std::min(bundle_count, first + input.selection->max_bundles);
        if (!work(kernel, first, end, &input.selection->lists(first, end))) {
            return false;
        }
    }
    return true;
}

template <typename Source>
bool Gatherer::gather(const GatherInput<Source>& input, GatherSums<Source>& sums,
                      const GatherProgress& progress) {
    const bool by_groups = input.selection == nullptr && input.strata == nullptr;
    if (by_groups && sums.groups.count() < input.group_count() * input.packet_count) {
        throw Error(ErrorKind::invalid_argument, "the sums of a gather were allocated for fewer groups");
    }
    Course course{progress, std::uint64_t{input.packet_count} * input.asked_count() * NEARLIGHT_PACKET_SIZE,
                  launch_pairs_};
    const bool whole = for_each_run(
        input, false, [&](Kernel& kernel, std::size_t first, std::size_t end, const VplLists* lists) {
            return gather_bundles(kernel, input, first, end, lists, sums, course);
        });
    // The next gather begins with a smaller launch, because gathers may differ in cost more than the parts of
    // one gather do.
    launch_pairs_ = std::max(course.budget / 4.0, std::min(launch_pairs_, course.budget));
    return whole;
}
template bool Gatherer::gather(const GatherInput<Vpl>&, GatherSums<Vpl>&, const GatherProgress&);
template bool Gatherer::gather(const GatherInput<Importon>&, GatherSums<Importon>&, const GatherProgress&);

std::vector<GatherPair> Gatherer::gather_recorded(const GatherInput<Vpl>& input, GatherSums<Vpl>& sums) {
    const std::size_t pairs = input.packet_count * input.vpl_count * NEARLIGHT_PACKET_SIZE;
    Buffer<std::uint8_t> record(*device_, pairs);
    record.fill_zero();
    for_each_run(input, true, [&](Kernel& kernel, std::size_t first, std::size_t end, const VplLists* lists) {
        launch(kernel, input, {first, end, 0, input.asked_count()}, lists, sums, record);
        return true;
    });
    std::vector<GatherPair> result(pairs);
    record.download(std::span(reinterpret_cast<std::uint8_t*>(result.data()), pairs));
    return result;
}

}  // namespace nearlight::core
