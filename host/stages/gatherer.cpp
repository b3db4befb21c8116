// SPDX-License-Identifier: Apache-2.0
#include "host/stages/gatherer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace nearlight {
namespace {

/// VPLs that are summed by themselves before they are added to the irradiance; launches end at multiples of
/// it.
constexpr std::size_t kChunk = 256;

/// Packets of a launch: enough to keep every core or lane busy until the end; more VPLs are better than more
/// packets, because a packet's start costs something.
constexpr std::size_t kCpuPackets = 1024;
constexpr std::size_t kGpuPackets = 16384;

/// Pairs of a launch at most, however fast the device is.
constexpr double kMostLaunchPairs = 0x1p40;

GatherConfig resolved(GatherConfig config, const Device& device) {
    if (config.kernel == GatherKernel::automatic) {
        config.kernel = device.is_cpu() ? GatherKernel::packets : GatherKernel::rays;
    }
    if (config.packet_width != 16 && config.packet_width != 32 && config.packet_width != 64) {
        throw Error(ExitCode::usage,
                    "a gather packet has 16, 32 or 64 lanes, not " + std::to_string(config.packet_width));
    }
    return config;
}

}  // namespace

/// One launch: packets [first_packet, end_packet) against VPLs [first_vpl, end_vpl).
struct Gatherer::Part {
    std::size_t first_packet = 0;
    std::size_t end_packet = 0;
    std::size_t first_vpl = 0;
    std::size_t end_vpl = 0;

    [[nodiscard]] std::uint64_t pairs() const {
        return std::uint64_t{end_packet - first_packet} * (end_vpl - first_vpl) * NEARLIGHT_PACKET_SIZE;
    }
};

Gatherer::Gatherer(Device& device, const GatherConfig& config)
    : device_(&device), config_(resolved(config, device)), kernel_(make_kernel(false)) {}

Kernel Gatherer::make_kernel(bool recording) const {
    Defines defines{{"GATHER_CHUNK", std::to_string(kChunk)}};
    if (recording) {
        defines.emplace("GATHER_RECORD", "1");
    }
    if (config_.kernel == GatherKernel::rays) {
        return {Program(*device_, "gather_rays.cl", defines), "gather_rays"};
    }
    defines.emplace("GATHER_PACKET_WIDTH", std::to_string(config_.packet_width));
    return {Program(*device_, "gather_packets.cl", defines), "gather_packets"};
}

/// The part after `done`: the same packets against further VPLs, or, when those are through, further packets.
Gatherer::Part Gatherer::next_part(const GatherInput& input, const Part& done,
                                   std::uint64_t pair_budget) const {
    constexpr std::uint64_t kChunkPairs = std::uint64_t{kChunk} * NEARLIGHT_PACKET_SIZE;
    Part part = done;
    if (done.end_vpl >= input.vpl_count) {
        const std::size_t most = device_->is_cpu() ? kCpuPackets : kGpuPackets;
        const std::size_t packets = std::clamp<std::uint64_t>(pair_budget / kChunkPairs, 1, most);
        part.first_packet = done.end_packet;
        part.end_packet = std::min(input.packet_count, part.first_packet + packets);
        part.end_vpl = 0;
    }
    const std::uint64_t chunks = pair_budget / (kChunkPairs * (part.end_packet - part.first_packet));
    part.first_vpl = part.end_vpl;
    part.end_vpl = std::min<std::uint64_t>(
        input.vpl_count, part.first_vpl + kChunk * std::clamp<std::uint64_t>(chunks, 1, 1u << 20u));
    return part;
}

template <typename... Record>
void Gatherer::launch(Kernel& kernel, const GatherInput& input, const Part& part,
                      Buffer<IrradiancePacket>& irradiance, const Record&... record) {
    const bool rays = config_.kernel == GatherKernel::rays;
    const std::size_t items_per_packet = NEARLIGHT_PACKET_SIZE / (rays ? 1 : config_.packet_width);
    const std::size_t items = (part.end_packet - part.first_packet) * items_per_packet;
    const auto launch_on = [&](std::size_t local_size, const auto& nodes, const auto& triangles) {
        kernel.launch(items, local_size, nodes, triangles, input.vpls, static_cast<cl_uint>(part.first_vpl),
                      static_cast<cl_uint>(part.end_vpl), input.receivers,
                      static_cast<cl_uint>(part.first_packet), static_cast<cl_uint>(part.end_packet),
                      input.clamp_radius * input.clamp_radius, irradiance, record...);
    };
    if (rays) {
        launch_on(device_->local_size(), input.nodes, input.triangles);
    } else {
        launch_on(1, input.wide_nodes, input.blocks);
    }
}

bool Gatherer::gather(const GatherInput& input, Buffer<IrradiancePacket>& irradiance,
                      const GatherProgress& progress) {
    using Clock = std::chrono::steady_clock;
    const std::uint64_t total = std::uint64_t{input.packet_count} * input.vpl_count * NEARLIGHT_PACKET_SIZE;
    double budget = std::clamp(static_cast<double>(config_.first_launch_pairs), 1.0, kMostLaunchPairs);
    std::uint64_t done = 0;
    Part part;
    part.end_vpl = input.vpl_count;
    while (part.end_packet < input.packet_count || part.end_vpl < input.vpl_count) {
        part = next_part(input, part, static_cast<std::uint64_t>(budget));
        const auto start = Clock::now();
        launch(kernel_, input, part, irradiance);
        device_->finish();
        const double seconds = std::max(1e-6, std::chrono::duration<double>(Clock::now() - start).count());
        // At most four times as much, because neighbouring parts may differ in cost.
        const double fitting = static_cast<double>(part.pairs()) * config_.launch_seconds / seconds;
        budget = std::clamp(fitting, 1.0, std::min(budget * 4.0, kMostLaunchPairs));
        done += part.pairs();
        if (progress && !progress(done, total)) {
            return false;
        }
    }
    return true;
}

std::vector<GatherPair> Gatherer::gather_recorded(const GatherInput& input,
                                                  Buffer<IrradiancePacket>& irradiance) {
    const std::size_t pairs = input.packet_count * input.vpl_count * NEARLIGHT_PACKET_SIZE;
    Buffer<std::uint8_t> record(*device_, pairs);
    Kernel kernel = make_kernel(true);
    Part all;
    all.end_packet = input.packet_count;
    all.end_vpl = input.vpl_count;
    launch(kernel, input, all, irradiance, record, static_cast<cl_uint>(input.vpl_count));
    std::vector<GatherPair> result(pairs);
    record.download(std::span(reinterpret_cast<std::uint8_t*>(result.data()), pairs));
    return result;
}

}  // namespace nearlight
