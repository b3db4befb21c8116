// SPDX-License-Identifier: Apache-2.0
// Irradiance as kernels/lib/receiver_path.cl finds it, at a point of a test's choice.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tests/support/kernel_probe.h"
#include "tests/support/scene_on_device.h"

namespace nearlight::core::test {

/// Direct irradiance, G, at a point by one light sample and as many rays, for each of these numbers of rays:
/// the mean over receivers with different random numbers.
inline std::vector<double> direct_irradiance(Device& device, const Scene& scene, Vec3 position, Vec3 normal,
                                             std::span<const uint> numbers_of_rays) {
    constexpr uint kReceivers = 65536;
    KernelProbe probe(device, R"(
#include "lib/receiver_path.cl"
kernel void probe(SCENE_PARAMETERS, float4 position, float4 normal, uint rays, global float* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    const ReceiverPoint at = {position.xyz, normal.xyz, (float3)(0.0f), 0};
    const PathLimits limits = {1, 1, INFINITY, 1, rays, 0, 0};
    Finds finds = nothing_shared();
    out[i] = received_light(&scene, &at, &limits, random_uint4((uint4)(i, 5, 6, 7)), &finds).direct.y;
}
)");
    const SceneOnDevice on_device(probe.device(), scene);
    Buffer<float> out(probe.device(), kReceivers);
    std::vector<double> means;
    for (const uint rays : numbers_of_rays) {
        probe.kernel().launch(kReceivers, 8, on_device.buffers,
                              std::array<float, 4>{position.x, position.y, position.z, 0},
                              std::array<float, 4>{normal.x, normal.y, normal.z, 0}, rays, out);
        double sum = 0;
        for (const float light : out.download()) {
            sum += light;
        }
        means.push_back(sum / kReceivers);
    }
    return means;
}

}  // namespace nearlight::core::test
