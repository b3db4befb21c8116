// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_tracer.h"

#include <algorithm>

#include "host/base/random.h"

namespace nearlight::core {
namespace {

constexpr uint kSlotsPerBatch = 1u << 18u;  // 12 MiB of VPLs

}  // namespace

LightTracer::LightTracer(Device& device)
    : device_(&device),
      program_(device, "light_tracer.cl"),
      light_tracer_(program_, "light_tracer"),
      compaction_(device) {}

std::vector<Vpl> LightTracer::run(const DeviceScene& scene, const CloseRegion& region, KeepDeposits keep,
                                  const LightWalks& walks) {
    std::vector<Vpl> deposits;
    run(scene, region, keep, walks, [&](const Buffer<Vpl>& vpls, std::size_t count) {
        deposits.resize(deposits.size() + count);
        vpls.download(std::span(deposits).last(count));
    });
    return deposits;
}

void LightTracer::run(const DeviceScene& scene, const CloseRegion& region, KeepDeposits keep,
                      const LightWalks& walks, const DepositVisitor& visit) {
    if (scene.host_info.emitter_count == 0 || walks.bounce_count == 0) {
        return;
    }
    const float absorption_shift = Pcg32(walks.seed, 0xab5).uniform();
    const auto slots_per_batch = static_cast<uint>(
        std::min<std::size_t>(kSlotsPerBatch, device_->entry().max_allocation_bytes / sizeof(Vpl)));
    const uint batch_size = std::min(walks.walk_count, std::max(1u, slots_per_batch / walks.bounce_count));
    const std::size_t slot_count = static_cast<std::size_t>(batch_size) * walks.bounce_count;
    Buffer<Vpl> slots(*device_, slot_count);
    Buffer<Vpl> kept(*device_, slot_count);
    Buffer<uint> flags(*device_, slot_count);
    Buffer<uint> indices(*device_, slot_count);
    for (uint first = 0; first < walks.walk_count; first += batch_size) {
        const uint count = std::min(batch_size, walks.walk_count - first);
        const LightTracerParams params{.whole_triangles = region.whole_triangles ? 1u : 0u,
                                       .keep = static_cast<uint>(keep),
                                       .first_walk = first,
                                       .walk_count = count,
                                       .bounce_count = walks.bounce_count,
                                       .all_walks = walks.walk_count,
                                       .min_survival = walks.min_survival,
                                       .max_survival = walks.max_survival,
                                       .absorption_shift = absorption_shift,
                                       .seed = walks.seed,
                                       .pad0 = 0,
                                       .pad1 = 0};
        light_tracer_.launch_items(count, scene, region.range, region.triangles, params, walks.aim, slots,
                                   flags);
        const std::size_t kept_count =
            compaction_.list_set(flags, static_cast<std::size_t>(count) * walks.bounce_count, indices);
        compaction_.gather(slots, indices, kept_count, kept);
        if (kept_count > 0) {
            visit(kept, kept_count);
        }
    }
}

}  // namespace nearlight::core
