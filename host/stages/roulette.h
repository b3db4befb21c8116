// SPDX-License-Identifier: Apache-2.0
// Russian roulette over the VPLs of a gather: few rays for what could bring little light. Kernels:
// roulette.cl.
#pragma once

#include "host/base/receiver_bundles.h"
#include "host/cl/buffer.h"
#include "host/cl/kernel.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Which VPLs each bundle of [first_bundle, end_bundle) asks about. Entry k of a bundle, k < counts[bundle −
/// first_bundle], is at (bundle − first_bundle)·stride + k of `vpls` (an index) and `weights` (1/p, what the
/// VPL counts).
struct RouletteLists {
    Buffer<uint> vpls;
    Buffer<float> weights;
    Buffer<uint> counts;
    uint first_bundle = 0;
    uint stride = 0;
};

struct RouletteTask {
    const Buffer<Vpl>& vpls;
    std::size_t vpl_count = 0;
    const Buffer<ReceiverPacket>& receivers;
    BundleLayout bundles;
    float clamp_radius = 0.0f;  ///< R of the bounded geometry term, scene units
    /// A bundle always asks about a VPL that could bring its receivers (root mean square, as if nothing were
    /// in the way) at least `threshold` times the mean over all VPLs; about others with a probability in
    /// proportion to what they could bring. Above 0.
    float threshold = 1.0f;
    uint seed = 0;
};

class Roulette {
  public:
    explicit Roulette(Device& device);

    /// Bundles whose lists fit into memory together, for so many VPLs; at least 1.
    [[nodiscard]] static std::size_t max_bundles(std::size_t vpl_count);

    /// The lists of bundles [first_bundle, end_bundle), at most max_bundles() of them; valid until the next
    /// call.
    const RouletteLists& choose(const RouletteTask& task, std::size_t first_bundle, std::size_t end_bundle);

  private:
    Device* device_;
    Program program_;
    Kernel bounds_kernel_;
    Kernel choose_kernel_;
    Buffer<float> bounds_;
    RouletteLists lists_;
};

}  // namespace nearlight::core
