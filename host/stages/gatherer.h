// SPDX-License-Identifier: Apache-2.0
// The gather: irradiance that VPLs send to receivers, or importance that importons send, with visibility
// tested for every pair.
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
#include "host/stages/vpl_selection.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

struct GatherConfig {
    GatherKernel kernel = GatherKernel::automatic;
    /// Of `packets`: 16, 32, 64, 128 or 256 receivers a tree traversal. The result does not depend on it. 0:
    /// what suits the device (Tunables).
    uint beam_width = 0;
    /// The first launch takes at most this many (receiver, VPL) pairs; those that follow, also of later
    /// gathers, are sized by the time it took. The result does not depend on it.
    std::uint64_t first_launch_pairs = std::uint64_t{1} << 20u;
    double launch_seconds = 0.0;  ///< how long a launch should take; 0: what suits the device
};

/// What arrives at a packet of receivers: irradiance from VPLs, importance from importons.
template <typename Source>
struct GatheredFrom;
template <>
struct GatheredFrom<Vpl> {
    using Packet = IrradiancePacket;
};
template <>
struct GatheredFrom<Importon> {
    using Packet = ImportancePacket;
};

/// What is gathered. Source is Vpl or Importon. Counts may be smaller than the buffers'.
template <typename Source>
struct GatherInput {
    const DeviceTree& tree;  ///< uploaded for the gatherer's kernel
    const Buffer<Source>& vpls;
    std::size_t vpl_count = 0;
    const Buffer<ReceiverPacket>& receivers;
    std::size_t packet_count = 0;
    float clamp_radius = 0.0f;  ///< R of the bounded geometry term, scene units
    /// Which VPLs each bundle asks about; null: all of them. Excludes groups.
    const VplSelection* selection = nullptr;
    /// Other than 0: sums by groups of so many VPLs that follow one another, in place of one sum.
    uint group_size = 0;
    /// Of each receiver (64 · packet + lane); pairs whose light, squared and without visibility, R, G and B
    /// together, would be less count for nothing. For estimates. Null: all count.
    const Buffer<float>* thresholds = nullptr;

    [[nodiscard]] std::size_t group_count() const {
        return group_size == 0 ? 0 : (vpl_count + group_size - 1) / group_size;
    }
    /// What goes through the tree together. Without a selection that does not matter to the result.
    [[nodiscard]] BundleLayout bundles() const {
        const auto count = static_cast<uint>(packet_count);
        return selection != nullptr ? selection->bundles : BundleLayout{count, std::max(count, 1u)};
    }
};

/// What a gather of VPLs or importons brings, in packets of 64 receivers.
template <typename Source>
struct GatherSums {
    using Packet = typename GatheredFrom<Source>::Packet;

    /// For a gather without groups, or with `group_count` of them.
    GatherSums(Device& device, std::size_t packet_count, std::size_t group_count = 0)
        : light(device, group_count == 0 ? packet_count : 0),
          squares(device, group_count == 0 ? 0 : packet_count),
          groups(device, group_count * packet_count) {}

    Buffer<Packet> light;    ///< without groups: the sum over all VPLs, in W/m² for light
    Buffer<Packet> squares;  ///< with groups: the sum over all VPLs of each one's square, channel by channel
    Buffer<Packet> groups;   ///< with groups: the sum over the VPLs of each, packet_count packets a group
};

/// Called between launches with the number of (receiver, VPL) pairs done so far and of all; false cancels.
using GatherProgress = std::function<bool(std::uint64_t done, std::uint64_t total)>;

/// What became of one (receiver, VPL) pair.
enum class GatherPair : std::uint8_t {
    /// No ray: a cosine is not positive (an absent receiver's is 0), something is not finite, the VPL is not
    /// in the bundle's list, or its light is less than the threshold.
    culled = 0,
    visible = 1,
    occluded = 2,
};

class Gatherer {
  public:
    /// Begins to compile the kernel; the first gather throws what went wrong (see Program). Throws
    /// Error(ErrorKind::invalid_argument) for a packet width that there is not.
    explicit Gatherer(Device& device, const GatherConfig& config = {});

    /// light[p] = Σ_i power_i/π · max0(cosθ_x)·max0(cosθ_y) / max(r², R²) · V over the VPLs [0, vpl_count),
    /// for each packet p of [0, packet_count). Sums are formed in a fixed order: the same bits for any
    /// division into launches and any number of threads. Pairs with NaN or infinity in them contribute
    /// nothing. Returns when done; false if `progress` cancelled, and then only part of the VPLs is summed.
    /// Throws Error(ErrorKind::invalid_argument) for groups with a selection.
    template <typename Source>
    bool gather(const GatherInput<Source>& input, GatherSums<Source>& sums,
                const GatherProgress& progress = {});

    /// The same, and what became of each pair: entry (packet·vpl_count + vpl)·64 + lane. For tests and
    /// benchmarks; a byte a pair.
    std::vector<GatherPair> gather_recorded(const GatherInput<Vpl>& input, GatherSums<Vpl>& sums);

    /// For which the tree must be uploaded; never `automatic`.
    [[nodiscard]] GatherKernel kernel() const { return config_.kernel; }

  private:
    struct Part;
    struct Course;
    [[nodiscard]] Kernel make_kernel(bool lists, bool recording) const;
    Kernel& kernel_of(bool lists, bool recording);
    template <typename Source>
    [[nodiscard]] Part next_part(const GatherInput<Source>& input, const Part& done, std::size_t end_bundle,
                                 std::uint64_t pair_budget) const;
    template <typename Source, typename... More>
    void launch(Kernel& kernel, const GatherInput<Source>& input, const Part& part, const VplLists* lists,
                GatherSums<Source>& sums, const More&... more);
    template <typename Source, typename... More>
    void launch_with(Kernel& kernel, const GatherInput<Source>& input, const Part& part,
                     GatherSums<Source>& sums, const More&... more);
    template <typename Source>
    bool gather_bundles(Kernel& kernel, const GatherInput<Source>& input, std::size_t first_bundle,
                        std::size_t end_bundle, const VplLists* lists, GatherSums<Source>& sums,
                        Course& course);
    template <typename Source, typename Work>
    bool for_each_run(const GatherInput<Source>& input, bool recording, const Work& work);

    Device* device_;
    GatherConfig config_;
    double launch_pairs_;          ///< of the next gather's first launch
    Buffer<GatherParams> params_;  ///< of a launch
    Buffer<uint> next_beam_;       ///< the queue of a launch of gather_packets: one number
    Buffer<float> no_thresholds_;
    // Made when first asked for, but for the plain kernel. Those with lists come last, of both kinds the
    // recording one second.
    std::array<std::optional<Kernel>, 4> kernels_;
};

}  // namespace nearlight::core
