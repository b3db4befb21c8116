// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_tracer.h"

#include <algorithm>

#include "host/base/random.h"

namespace nearlight::core {
namespace {

constexpr uint kSlotsPerBatch = 1u << 20u;  // 48 MiB of VPLs

}  // namespace

LightTracer::LightTracer(Device& device)
    : device_(&device),
      program_(device, "light_tracer.cl"),
      light_tracer_(program_, "light_tracer"),
      collect_(program_, "light_tracer_collect"),
      scan_(device) {}

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
    Buffer<Vpl> slots(*device_, static_cast<std::size_t>(batch_size) * walks.bounce_count);
    Buffer<Vpl> kept;
    Buffer<uint> counts(*device_, batch_size);
    Buffer<uint> begins(*device_, batch_size);
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
                                   counts);
        scan_.exclusive(counts, begins, count);
        const std::size_t kept_count = scan_.total().download().front();
        if (kept_count > 0) {
            ensure_room(kept, *device_, kept_count);
            collect_.launch_items(count, slots, counts, begins, count, walks.bounce_count, kept);
            visit(kept, kept_count);
        }
    }
}

}  // namespace nearlight::core
