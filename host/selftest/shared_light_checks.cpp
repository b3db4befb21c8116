// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/checks.h"

#include "host/base/receivers.h"
#include "host/reference/edge_excuse.h"
#include "host/reference/embree_scene.h"
#include "host/reference/gather_workload.h"
#include "host/reference/shared_light_oracle.h"
#include "host/reference/test_rooms.h"
#include "host/stages/shared_lights.h"

namespace nearlight::core {
namespace {

/// T of the curve 1, which is straight, so that it is the same between the entries of its table.
double transmission(double cosine) {
    return 0.25 + 0.5 * cosine;
}

Scene room_with_a_curve() {
    Scene scene = make_delta_lit_room();
    scene.transmission_curves.assign(2 * std::size_t{NEARLIGHT_CURVE_SIZE}, 1.0f);
    for (std::size_t i = 0; i < NEARLIGHT_CURVE_SIZE; ++i) {
        const double cosine = static_cast<double>(i) / (NEARLIGHT_CURVE_SIZE - 1);
        scene.transmission_curves[NEARLIGHT_CURVE_SIZE + i] = static_cast<float>(transmission(cosine));
    }
    return scene;
}

}  // namespace

void check_shared_lights(Device& device, CheckResult& result) {
    const Scene scene = room_with_a_curve();
    const Bvh bvh = build_scene_bvh(scene);
    const EmbreeScene embree(scene);
    const float extent = max_component(bounds(scene).size());
    const double tolerance = kSegmentEdgeTolerance * extent;
    const SharedLightCase data = make_shared_lights(
        make_camera_receivers(scene, bvh, 48, 48), 0.3f * extent,
        [&](Vec3 from, Vec3 to) { return distance_to_edges(bvh.triangles, from, to) > tolerance; });
    const std::vector<Vec3> wanted = shared_irradiance(
        data, [&](Vec3 from, Vec3 to) { return !embree.blocked(from, to); }, transmission);
    const ReceiverPathSettings settings{.path_count = data.rays_per_receiver,
                                        .max_edges = data.max_edges,
                                        .clamp_radius = data.clamp_radius,
                                        .seed = 1};
    const Buffer<ReceiverPacket> receivers(device, data.receivers);
    const Buffer<SharedLight> lights(device, data.found);
    for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
        const DeviceScene on_device = upload_scene(device, scene, bvh, kernel);
        Buffer<IrradiancePacket> irradiance(device, data.receivers.size());
        irradiance.fill_zero();
        SharedLights(device, kernel)
            .add(on_device, receivers, data.receivers.size(), settings, lights, irradiance);
        const std::vector<IrradiancePacket> found = irradiance.download();
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const Vec3 difference = irradiance_at(found, i) - wanted[i];
            result.expect(length(difference) <= 1e-3f * length(wanted[i]) + 1e-6f);
        }
    }
}

}  // namespace nearlight::core
