// SPDX-License-Identifier: Apache-2.0
// The gather: irradiance that a VPL set sends to receivers, with visibility tested for every pair.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "host/stages/roulette.h"
#include "kernels/shared/types.h"

namespace nearlight {

/// Which kernel does the work. Both compute the same sum; visibility may differ for rays that meet an edge of
/// a triangle within rounding.
enum class GatherKernel {
    automatic,  ///< packets on CPUs, rays elsewhere
    packets,    ///< gather_packets.cl: one work-item, up to 256 receivers in vector registers
    rays,       ///< gather_rays.cl: one work-item, one receiver
};

struct GatherConfig {
    GatherKernel kernel = GatherKernel::automatic;
    /// Of `packets`: 16, 32, 64, 128 or 256 receivers a tree traversal; with roulette at most 64. The result
    /// does not depend on it.
    uint packet_width = 4 * NEARLIGHT_PACKET_SIZE;
    /// The first launch takes at most this many (receiver, VPL) pairs; those that follow are sized by the
    /// time it took. The result does not depend on it.
    std::uint64_t first_launch_pairs = std::uint64_t{1} << 20u;
    double launch_seconds = 0.2;  ///< how long a launch should take
};

/// What is gathered. The trees hold the opaque surfaces. Counts may be smaller than the buffers'.
struct GatherInput {
    const Buffer<BvhNode>& nodes;  ///< of the binary tree, which `rays` goes through
    const Buffer<BvhTriangle>& triangles;
    const Buffer<WideNode>& wide_nodes;  ///< of the same tree widened, which `packets` goes through
    const Buffer<TriangleBlock>& blocks;
    const Buffer<Vpl>& vpls;
    std::size_t vpl_count = 0;
    const Buffer<ReceiverPacket>& receivers;
    std::size_t packet_count = 0;
    float clamp_radius = 0.0f;  ///< R of the bounded geometry term, scene units
    /// Threshold of the Russian roulette (RouletteTask); 0: every pair is resolved. The expectation is the
    /// same.
    float roulette = 0.0f;
    uint seed = 0;  ///< of the roulette
};

/// Called between launches with the number of (receiver, VPL) pairs done so far and of all; false cancels.
using GatherProgress = std::function<bool(std::uint64_t done, std::uint64_t total)>;

/// What became of one (receiver, VPL) pair.
enum class GatherPair : std::uint8_t {
    /// No ray: a cosine is not positive (an absent receiver's is 0), something is not finite, or the roulette
    /// passed over the VPL.
    culled = 0,
    visible = 1,
    occluded = 2,
};

class Gatherer {
  public:
    /// Compiles the kernel. Throws Error(ExitCode::kernel_build).
    explicit Gatherer(Device& device, const GatherConfig& config = {});

    /// irradiance[p] = Σ_i power_i/π · max0(cosθ_x)·max0(cosθ_y) / max(r², R²) · V over the VPLs [0,
    /// vpl_count), in W/m², for each packet p of [0, packet_count). Sums are formed in a fixed order: the
    /// same bits for any division into launches and any number of threads. Pairs with NaN or infinity in them
    /// contribute nothing. Returns when done; false if `progress` cancelled, and then only part of the VPLs
    /// is summed.
    bool gather(const GatherInput& input, Buffer<IrradiancePacket>& irradiance,
                const GatherProgress& progress = {});

    /// The same, and what became of each pair: entry (packet·vpl_count + vpl)·64 + lane. For tests and
    /// benchmarks; a byte a pair.
    std::vector<GatherPair> gather_recorded(const GatherInput& input, Buffer<IrradiancePacket>& irradiance);

    [[nodiscard]] GatherKernel kernel() const { return config_.kernel; }

  private:
    struct Part;
    struct Course;
    [[nodiscard]] Kernel make_kernel(bool roulette, bool recording) const;
    [[nodiscard]] uint item_width(bool roulette) const;
    [[nodiscard]] Part next_part(std::size_t vpl_count, bool roulette, const Part& done,
                                 std::size_t end_packet, std::uint64_t pair_budget) const;
    template <typename... More>
    void launch(Kernel& kernel, const GatherInput& input, const Part& part,
                Buffer<IrradiancePacket>& irradiance, const More&... more);
    template <typename... More>
    bool gather_packets(Kernel& kernel, const GatherInput& input, std::size_t first_packet,
                        std::size_t end_packet, Buffer<IrradiancePacket>& irradiance, Course& course,
                        const More&... more);
    const RouletteLists& choose(const GatherInput& input, std::size_t first_packet, std::size_t end_packet);

    Device* device_;
    GatherConfig config_;
    Kernel kernel_;
    std::optional<Roulette> roulette_;  ///< compiled when first asked for, like the kernel that follows it
    std::optional<Kernel> roulette_kernel_;
};

}  // namespace nearlight
