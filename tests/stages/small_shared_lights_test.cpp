// SPDX-License-Identifier: Apache-2.0
// Small launches (small_launches.h) of the stages that share among bundles what their rays find.
#include <vector>

#include "host/stages/receiver_paths.h"
#include "host/stages/shared_lights.h"
#include "host/stages/shared_reflections.h"
#include "host/stages/shared_sky.h"
#include "host/stages/shared_veiled.h"
#include "tests/stages/small_launches.h"

namespace nearlight::core {
namespace {

using test::bright_corner;
using test::few_receivers;
using test::Numbers;
using test::numbers_of;
using test::SmallLaunchesTest;

Numbers emitted_by(const std::vector<CameraVertex>& vertices) {
    Numbers numbers;
    for (const CameraVertex& vertex : vertices) {
        numbers.push_back(vertex.traced_direct.y);
    }
    return numbers;
}

/// What the rays of a packet's receivers find, as lights of all of them.
Numbers shared_lights(Device& device, GatherKernel kernel) {
    const test::SceneOnDevice scene(device, bright_corner());
    const DeviceScene on_device = upload_scene(device, scene.scene, scene.bvh, kernel);
    const std::vector<ReceiverPacket> packets = few_receivers(scene, 8, 8);
    const Buffer<ReceiverPacket> receivers(device, packets);
    const ReceiverPathSettings settings{.light_samples = 1,
                                        .rays = 1,
                                        .max_edges = 3,
                                        .clamp_radius = 0.8f,
                                        .seed = 2,
                                        .shares_sky = true,
                                        .shares_veiled = true,
                                        .shares_reflections = true};
    Buffer<IrradiancePacket> direct(device, packets.size());
    Buffer<IrradiancePacket> indirect(device, packets.size());
    FoundLights found(device, packets.size(), settings);
    const ReceiverBatch batch{on_device, receivers, packets.size(), settings};
    ReceiverPaths(device).run_sharing(batch, direct, indirect, found);
    SharedLightLists lists(device, kernel);
    SharedLights(device).add(batch, lists, found.near, indirect);
    SharedReflections(device).add(batch, lists, found, indirect);
    SharedVeiled(device).add(batch, lists, found.veiled, indirect);
    Numbers numbers = numbers_of(indirect.download());
    const std::size_t count = packets.size() * NEARLIGHT_PACKET_SIZE;
    const SeenSurface seen{
        .triangle = 4, .u = 0.3f, .v = 0.3f, .model = 0.5f, .direction = {0, -1, 0}, .light_samples = 1};
    Buffer<CameraVertex> vertices(device, std::vector(count, CameraVertex{}));
    SharedSky(device).add(
        batch, lists, found.sky,
        {.surfaces = Buffer<SeenSurface>(device, std::vector(count, seen)), .vertices = vertices}, direct);
    for (const Numbers& more : {numbers_of(direct.download()), emitted_by(vertices.download())}) {
        numbers.insert(numbers.end(), more.begin(), more.end());
    }
    return numbers;
}

TEST_F(SmallLaunchesTest, SharedLightsByPackets) {
    expect_same_of_both_trees([](Device& device) { return shared_lights(device, GatherKernel::packets); });
}

TEST_F(SmallLaunchesTest, SharedLightsByRays) {
    expect_same_of_both_trees([](Device& device) { return shared_lights(device, GatherKernel::rays); });
}

}  // namespace
}  // namespace nearlight::core
