// SPDX-License-Identifier: Apache-2.0
// The gather: irradiance that VPLs send to receivers, or importance that importons send, with visibility
// tested for every pair.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host/base/division.h"
#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "host/stages/device_tree.h"
#include "host/stages/vpl_selection.h"
#include "host/stages/vpl_strata.h"
#include "kernels/shared/gather_record.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

struct GatherConfig {
    GatherKernel kernel = GatherKernel::automatic;
    /// The width of a beam of the kernel `packets`: 16, 32, 64, 128 or 256 receivers per tree traversal; 0
    /// takes the width of the device's Tunables. The result does not depend on it.
    uint beam_width = 0;
    /// The maximum number of (receiver, VPL) pairs in the first launch. Later launches, those of later
    /// gathers included, are sized by the time that earlier ones took. The result does not depend on it.
    std::uint64_t first_launch_pairs = std::uint64_t{1} << 20u;
    double launch_seconds = 0.0;  ///< how long a launch should take; 0: the time in the device's Tunables
};

/// The type of what arrives at a packet of receivers: irradiance from VPLs, importance from importons.
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

/// What a gather works on. Source is Vpl or Importon. Counts may be smaller than those of the buffers.
template <typename Source>
struct GatherInput {
    const DeviceTree& tree;  ///< uploaded for the gatherer's kernel
    const Buffer<Source>& vpls;
    std::size_t vpl_count = 0;
    const Buffer<ReceiverPacket>& receivers;
    std::size_t packet_count = 0;
    float clamp_radius = 0.0f;  ///< R of the bounded geometry term, m
    /// The strata that bundles ask about; null means the whole set. Cannot be combined with groups.
    const VplStrata* strata = nullptr;
    /// The VPLs of its stratum that each bundle asks about; null means all of them. Cannot be combined with
    /// groups.
    const VplSelection* selection = nullptr;
    /// The number of consecutive VPLs in each group that is summed by itself; 0 makes one sum over all VPLs.
    uint group_size = 0;
    /// A threshold for each receiver (64 · packet + lane), for use in estimates. A pair contributes nothing
    /// if the squares of its unoccluded R, G and B add up to less than the receiver's threshold. Null means
    /// that every pair contributes.
    const Buffer<float>* thresholds = nullptr;
    /// The transmission curves of the surfaces, which weigh light at both ends; null means that they are 1.
    const Buffer<float>* curves = nullptr;
    bool has_maps = false;  ///< whether normal and bump maps of receivers shadow the light that they get

    [[nodiscard]] std::size_t group_count() const {
        return group_size == 0 ? 0 : divide_rounding_up(vpl_count, group_size);
    }
    /// The maximum number of VPLs that a bundle asks about.
    [[nodiscard]] std::size_t asked_count() const {
        return selection != nullptr ? selection->max_length
               : strata != nullptr  ? strata->max_size(vpl_count)
                                    : vpl_count;
    }
    /// The packets that are gathered together. Without strata and selection, the result does not depend on
    /// it.
    [[nodiscard]] BundleLayout bundles() const { return {static_cast<uint>(packet_count)}; }
};

/// The result of a gather of VPLs or importons, in packets of 64 receivers.
template <typename Source>
struct GatherSums {
    using Packet = typename GatheredFrom<Source>::Packet;

    /// Allocates the sums of a gather with `group_count` groups; 0 means without groups.
    GatherSums(Device& device, std::size_t packet_count, std::size_t group_count = 0)
        : light(device, group_count == 0 ? packet_count : 0),
          squares(device, group_count == 0 ? 0 : packet_count),
          groups(device, group_count * packet_count) {}

    Buffer<Packet> light;    ///< without groups: the sum over all VPLs, in W/m² for light
    Buffer<Packet> squares;  ///< with groups: the sum of squares over all VPLs, channel by channel
    Buffer<Packet> groups;   ///< with groups: packet_count packets per group, the sum over its VPLs
};

/// Called between launches with the number of (receiver, VPL) pairs that are done and their total number.
/// Returns false to cancel.
using GatherProgress = std::function<bool(std::uint64_t done, std::uint64_t total)>;

/// What became of one (receiver, VPL) pair.
enum class GatherPair : std::uint8_t {
    /// No ray was traced: a cosine is not positive (that of an absent receiver is 0), a value is not finite,
    /// the VPL is not in the bundle's stratum or list, or its light is below the threshold.
    culled = NEARLIGHT_PAIR_CULLED,
    visible = NEARLIGHT_PAIR_VISIBLE,
    occluded = NEARLIGHT_PAIR_OCCLUDED,
};

class Gatherer {
  public:
    /// Begins to compile the kernel; if that fails, the first gather throws the error (see Program). Throws
    /// Error(ErrorKind::invalid_argument) for a width that the kernel does not have.
    explicit Gatherer(Device& device, const GatherConfig& config = {});

    /// Begins to compile the kernel for selections, which otherwise begins when it is first needed.
    void expect_selections() { kernel_of(true, false); }

    /// light[p] = Σ_i power_i/π · T·T·max0(cosθ_x)·max0(cosθ_y) / max(r², R²) · V over the VPLs [0,
    /// vpl_count), for each packet p of [0, packet_count). With strata, the sum is over the stratum of the
    /// packet's bundle, times their number. Sums are formed in a fixed order, so their bits depend neither on
    /// the division into launches nor on the number of threads. Pairs that contain NaN or infinity contribute
    /// nothing. Waits for the device. Returns false if `progress` cancelled; the sums then cover only part of
    /// the VPLs. Throws Error(ErrorKind::invalid_argument) for groups together with strata or a selection and
    /// for sums of fewer groups, and Error(ErrorKind::failure) for a tree of another kernel.
    template <typename Source>
    bool gather(const GatherInput<Source>& input, GatherSums<Source>& sums,
                const GatherProgress& progress = {});

    /// Gathers as gather() does and returns what became of each pair, as entry (packet·vpl_count + vpl)·64 +
    /// lane. It takes a byte per pair and is meant for tests and benchmarks.
    std::vector<GatherPair> gather_recorded(const GatherInput<Vpl>& input, GatherSums<Vpl>& sums);

    /// The kernel that gathers, for which the tree must be uploaded; never `automatic`.
    [[nodiscard]] GatherKernel kernel() const { return config_.kernel; }

  private:
    struct Part;
    struct Course;
    [[nodiscard]] Kernel make_kernel(bool lists, bool recording) const;
    Kernel& kernel_of(bool lists, bool recording);
    template <typename Source>
    [[nodiscard]] Part next_part(const GatherInput<Source>& input, const Part& done, std::size_t end_bundle,
                                 std::uint64_t pair_budget) const;
    template <typename Source>
    [[nodiscard]] const VplStrata& strata_of(const GatherInput<Source>& input) const {
        return input.strata != nullptr ? *input.strata : whole_set_;
    }
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
    double launch_pairs_;          ///< pairs in the first launch of the next gather
    Buffer<GatherParams> params_;  ///< parameters of a launch
    Buffer<uint> next_beam_;       ///< the queue of one launch of gather_packets: a single counter
    Buffer<float> no_numbers_;     ///< in place of thresholds or curves
    VplStrata whole_set_;          ///< in place of strata
    // All kernels but the plain one are made when they are first needed. Their order is: plain, recording,
    // with lists, recording with lists.
    std::array<std::optional<Kernel>, 4> kernels_;
};

}  // namespace nearlight::core
