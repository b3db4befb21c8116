// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/checks.h"

#include "host/base/packed_direction.h"
#include "host/base/receivers.h"
#include "host/reference/edge_excuse.h"
#include "host/reference/embree_scene.h"
#include "host/reference/gather_workload.h"
#include "host/reference/reference_gather.h"
#include "host/reference/synthetic_scene.h"
#include "host/stages/gatherer.h"

namespace nearlight::core {
namespace {

constexpr float kGatherRadius = 0.05f;

/// Every third VPL gets a shading normal of its own.
void tilt_some(std::vector<Vpl>& vpls) {
    for (std::size_t i = 0; i < vpls.size(); i += 3) {
        const Vec3 aside = i % 2 == 0 ? Vec3{0.5f, 0.3f, 0.0f} : Vec3{0.0f, -0.4f, 0.6f};
        vpls[i].flags |= NEARLIGHT_VPL_TILTED;
        vpls[i].shading = pack_direction(normalize(vpls[i].normal + aside));
    }
}

}  // namespace

void check_gather(Device& device, GatherKernel kernel, CheckResult& result) {
    const Scene scene = make_sphere_room(3000);
    const Bvh bvh = build_scene_bvh(scene);
    const std::vector<ReceiverPacket> receivers = make_camera_receivers(scene, bvh, 64, 48);
    std::vector<Vpl> vpls = make_traced_vpls(scene, bvh, 80);
    tilt_some(vpls);
    EdgeExcuse edges(bvh.triangles, max_component(bounds(scene).size()));

    const DeviceTree tree = upload_tree(device, bvh, kernel);
    const Buffer<Vpl> vpl_buffer(device, vpls);
    const Buffer<ReceiverPacket> receiver_buffer(device, receivers);
    GatherSums<Vpl> sums(device, receivers.size());
    const std::vector<GatherPair> pairs =
        Gatherer(device, {.kernel = kernel})
            .gather_recorded(
                {tree, vpl_buffer, vpls.size(), receiver_buffer, receivers.size(), kGatherRadius}, sums);

    const EmbreeScene embree(scene);
    std::vector<IrradiancePacket> expected(receivers.size());
    gather_reference(embree, vpls, kGatherRadius, receivers, expected);
    const std::vector<IrradiancePacket> found = sums.light.download();
    for (std::size_t r = 0; r < receivers.size() * NEARLIGHT_PACKET_SIZE; ++r) {
        const std::size_t packet = r / NEARLIGHT_PACKET_SIZE;
        const std::size_t lane = r % NEARLIGHT_PACKET_SIZE;
        const Vec3 x = receiver_at(receivers, r).position;
        bool rays_agree = true;
        for (std::size_t v = 0; v < vpls.size(); ++v) {
            const GatherPair pair = pairs[(packet * vpls.size() + v) * NEARLIGHT_PACKET_SIZE + lane];
            if (pair == GatherPair::culled) {
                continue;
            }
            const bool agree = embree.blocked(vpls[v].position, x) == (pair == GatherPair::occluded);
            result.expect(agree || edges.excuses(vpls[v].position, x));
            rays_agree = rays_agree && agree;
        }
        if (rays_agree) {
            const float want = expected[packet].g[lane];
            result.expect(std::abs(found[packet].g[lane] - want) <= 1e-4f * want + 1e-9f);
        }
    }
}

}  // namespace nearlight::core
