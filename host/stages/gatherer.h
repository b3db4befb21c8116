// SPDX-License-Identifier: Apache-2.0
// The gather: irradiance that a VPL set sends to receivers, with visibility tested for every pair.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "host/stages/device_tree.h"
#include "host/stages/roulette.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

struct GatherConfig {
    GatherKernel kernel = GatherKernel::automatic;
    /// Of `packets`: 16, 32, 64, 128 or 256 receivers a tree traversal. The result does not depend on it. 0:
    /// what suits the device (Tunables).
    uint packet_width = 0;
    /// The first launch takes at most this many (receiver, VPL) pairs; those that follow, also of later
    /// gathers, are sized by the time it took. The result does not depend on it.
    std::uint64_t first_launch_pairs = std::uint64_t{1} << 20u;
    double launch_seconds = 0.0;  ///< how long a launch should take; 0: what suits the device
};

/// What is gathered. Counts may be smaller than the buffers'.
struct GatherInput {
    const DeviceTree& tree;  ///< uploaded for the gatherer's kernel
    const Buffer<Vpl>& vpls;
    std::size_t vpl_count = 0;
    const Buffer<ReceiverPacket>& receivers;
    std::size_t packet_count = 0;
    float clamp_radius = 0.0f;  ///< R of the bounded geometry term, scene units
    /// Threshold of the Russian roulette (RouletteTask); 0: every pair is resolved. The expectation is the
    /// same.
    float roulette = 0.0f;
    uint seed = 0;  ///< of the roulette
    /// Other than 0: sums by groups of so many VPLs that follow one another (gather()). Excludes the
    /// roulette.
    uint group_size = 0;
    /// Of each receiver (64 · packet + lane); pairs whose light, squared and without visibility, R, G and B
    /// together, would be less count for nothing. For estimates. Null: all count.
    const Buffer<float>* least = nullptr;
    /// Packets of which roulette's bundles are formed together (BundleLayout): the result depends on which
    /// receivers decide together. 0: all of them.
    uint run_packets = 0;

    [[nodiscard]] std::size_t group_count() const {
        return group_size == 0 ? 0 : (vpl_count + group_size - 1) / group_size;
    }

    /// What goes through the tree together. Without roulette runs do not matter to the result.
    [[nodiscard]] BundleLayout bundles() const {
        const auto count = static_cast<uint>(packet_count);
        return {count, roulette > 0.0f && run_packets > 0 ? run_packets : std::max(count, 1u)};
    }
};

/// Called between launches with the number of (receiver, VPL) pairs done so far and of all; false cancels.
using GatherProgress = std::function<bool(std::uint64_t done, std::uint64_t total)>;

/// What became of one (receiver, VPL) pair.
enum class GatherPair : std::uint8_t {
    /// No ray: a cosine is not positive (an absent receiver's is 0), something is not finite, the roulette
    /// passed over the VPL, or its light is less than the least.
    culled = 0,
    visible = 1,
    occluded = 2,
};

class Gatherer {
  public:
    /// Begins to compile the kernel; the first gather throws what went wrong (see Program). Throws
    /// Error(ErrorKind::invalid_argument) for a packet width that there is not.
    explicit Gatherer(Device& device, const GatherConfig& config = {});

    /// irradiance[p] = Σ_i power_i/π · max0(cosθ_x)·max0(cosθ_y) / max(r², R²) · V over the VPLs [0,
    /// vpl_count), in W/m², for each packet p of [0, packet_count). Sums are formed in a fixed order: the
    /// same bits for any division into launches and any number of threads. Pairs with NaN or infinity in them
    /// contribute nothing. Returns when done; false if `progress` cancelled, and then only part of the VPLs
    /// is summed.
    ///
    /// With groups, `irradiance` must have packet_count · (1 + group_count()) packets: the first packet_count
    /// get the sum of squares Σ_i (power_i/π · …)², channel by channel, the next as many the sum over the
    /// first group, and so on. Throws Error(ErrorKind::invalid_argument) for groups with roulette.
    bool gather(const GatherInput& input, Buffer<IrradiancePacket>& irradiance,
                const GatherProgress& progress = {});

    /// The same, and what became of each pair: entry (packet·vpl_count + vpl)·64 + lane. For tests and
    /// benchmarks; a byte a pair.
    std::vector<GatherPair> gather_recorded(const GatherInput& input, Buffer<IrradiancePacket>& irradiance);

    /// For which the tree must be uploaded; never `automatic`.
    [[nodiscard]] GatherKernel kernel() const { return config_.kernel; }

  private:
    struct Part;
    struct Course;
    [[nodiscard]] Kernel make_kernel(bool roulette, bool recording) const;
    Kernel& kernel_of(bool roulette, bool recording);
    [[nodiscard]] Part next_part(const GatherInput& input, const Part& done, std::size_t end_bundle,
                                 std::uint64_t pair_budget) const;
    template <typename... More>
    void launch(Kernel& kernel, const GatherInput& input, const Part& part,
                Buffer<IrradiancePacket>& irradiance, const More&... more);
    template <typename... More>
    bool gather_bundles(Kernel& kernel, const GatherInput& input, std::size_t first_bundle,
                        std::size_t end_bundle, Buffer<IrradiancePacket>& irradiance, Course& course,
                        const More&... more);
    template <typename Work>
    bool for_each_run(const GatherInput& input, bool recording, const Work& work);

    Device* device_;
    GatherConfig config_;
    double launch_pairs_;       ///< of the next gather's first launch
    Buffer<uint> next_packet_;  ///< the queue of a launch of gather_packets: one number
    Buffer<float> no_least_;
    // Made when first asked for, but for the plain kernel. Those with roulette come last, of both kinds the
    // recording one second.
    std::array<std::optional<Kernel>, 4> kernels_;
    std::optional<Roulette> roulette_;
};

}  // namespace nearlight::core
