// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_tracer.h"

#include <algorithm>

#include "host/base/random.h"

namespace nearlight {

LightTracer::LightTracer(Device& device)
    : device_(&device), program_(device, "light_tracer.cl"), light_tracer_(program_, "light_tracer") {}

void LightTracer::run(const DeviceScene& scene, const CloseRegion& region, KeepDeposits keep, const LightWalks& walks,
                      float mean_albedo, Buffer<Vpl>& vpls, Buffer<uint>& flags) {
    // Keller's fractional absorption: ρ̄^(j−1)·N walks go on to depth j. The bounds keep deep light from costing
    // as much as all the rest (bright rooms), or from being carried by hardly any walk (dark ones).
    const float survival = std::clamp(mean_albedo, 0.2f, 0.9f);
    std::vector<float> walks_at_depth;
    float launched = static_cast<float>(walks.walk_count);
    for (uint depth = 1; depth <= walks.bounce_count; ++depth, launched *= survival) {
        walks_at_depth.push_back(launched);
    }
    const Buffer<float> launched_buffer(*device_, walks_at_depth);
    const float absorption_shift = Pcg32(walks.seed, 0xab5).uniform();
    light_tracer_.launch_items(walks.walk_count, scene, region.range, region.triangles,
                               region.whole_triangles ? 1u : 0u, static_cast<uint>(keep), walks.walk_count,
                               walks.bounce_count, launched_buffer, absorption_shift, walks.seed, vpls, flags);
    device_->finish();  // launched_buffer must outlive the kernel
}

}  // namespace nearlight
