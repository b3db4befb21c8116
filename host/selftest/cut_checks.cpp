// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "host/base/receivers.h"
#include "host/reference/gather_workload.h"
#include "host/reference/synthetic_scene.h"
#include "host/selftest/checks.h"
#include "host/stages/gatherer.h"
#include "host/stages/light_cuts.h"
#include "host/stages/vpl_order.h"

namespace nearlight::core {
namespace {

constexpr float kCutRadius = 0.05f;
constexpr std::size_t kAskedCount = 25;
constexpr uint kShifts = 100;
/// The maximum distance of the mean from the light of all VPLs, in standard errors of as many independent
/// shifts. Evenly spaced shifts come much closer.
constexpr double kMaxCutErrors = 2.0;

struct CutCase {
    std::vector<ReceiverPacket> receivers;
    DeviceTree tree;
    VplBuffer vpls;
    Buffer<ReceiverPacket> receiver_buffer;

    [[nodiscard]] GatherInput<Vpl> input(const VplSelection* selection) const {
        return {.tree = tree,
                .vpls = vpls.buffer(),
                .vpl_count = vpls.count(),
                .receivers = receiver_buffer,
                .packet_count = receivers.size(),
                .clamp_radius = kCutRadius,
                .selection = selection};
    }
};

CutCase make_cut_case(Device& device) {
    const Scene scene = make_sphere_room(3000);
    const Bvh bvh = build_scene_bvh(scene);
    CutCase data;
    data.vpls = VplOrder(device).sort(make_traced_vpls(scene, bvh, 1000));
    data.receivers = make_camera_receivers(scene, bvh, 40, 24);
    data.tree = upload_tree(device, bvh);
    data.receiver_buffer = {device, data.receivers};
    return data;
}

/// Whether a node's box, axis and spread hold a VPL.
bool holds(const CutNode& node, const Vpl& vpl) {
    const Vec3 p = vpl.position;
    const bool inside = p.x >= node.low.x && p.y >= node.low.y && p.z >= node.low.z && p.x <= node.high.x &&
                        p.y <= node.high.y && p.z <= node.high.z;
    return inside && length(vpl.normal - node.axis) <= node.spread + 1e-5f;
}

/// Compares the nodes of every level with the VPLs below them.
void check_nodes(const CutCase& data, const CutTree& tree, CheckResult& result) {
    const std::vector<CutNode> nodes = tree.nodes.download();
    const std::vector<Vpl> vpls = data.vpls.download();
    std::size_t run = NEARLIGHT_CUT_FANOUT;
    for (std::size_t level = 0; level + 1 < tree.first_nodes.size(); ++level) {
        std::vector<double> powers(tree.first_nodes[level + 1] - tree.first_nodes[level]);
        for (std::size_t i = 0; i < vpls.size(); ++i) {
            result.expect(holds(nodes[tree.first_nodes[level] + i / run], vpls[i]));
            powers[i / run] += max_component(vpls[i].power) / static_cast<double>(kPi);
        }
        for (std::size_t i = 0; i < powers.size(); ++i) {
            const double power = nodes[tree.first_nodes[level] + i].power;
            result.expect(std::abs(power - powers[i]) <= 1e-4 * powers[i]);
        }
        run *= NEARLIGHT_CUT_FANOUT;
    }
}

/// Compares the mean over many shifts with the light of all VPLs, receiver by receiver.
void check_mean(Device& device, const CutCase& data, LightCuts& cuts, const CutTree& tree,
                CheckResult& result) {
    Gatherer gatherer(device);
    GatherSums<Vpl> sums(device, data.receivers.size());
    gatherer.gather(data.input(nullptr), sums);
    const std::vector<IrradiancePacket> full = sums.light.download();
    const std::size_t count = full.size() * NEARLIGHT_PACKET_SIZE;
    std::vector<double> deviation(count);  // sum over the shifts
    std::vector<double> squares(count);
    for (uint shift = 0; shift < kShifts; ++shift) {
        const VplStrata strata(device, kShifts, std::vector{shift});
        const VplSelection selection = cuts.select({.vpls = data.vpls.buffer(),
                                                    .tree = tree,
                                                    .receivers = data.receiver_buffer,
                                                    .packet_count = data.receivers.size(),
                                                    .strata = strata,
                                                    .clamp_radius = kCutRadius,
                                                    .asked_count = kAskedCount * kShifts,
                                                    .seed = 1});
        gatherer.gather(data.input(&selection), sums);
        const std::vector<IrradiancePacket> some = sums.light.download();
        for (std::size_t i = 0; i < count; ++i) {
            const double difference = double{irradiance_at(some, i).y} - irradiance_at(full, i).y;
            deviation[i] += difference;
            squares[i] += difference * difference;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double mean = deviation[i] / kShifts;
        const double error = std::sqrt((squares[i] / kShifts - mean * mean) / (kShifts - 1));
        result.expect(std::abs(mean) <= kMaxCutErrors * error + 1e-5 * irradiance_at(full, i).y);
    }
}

}  // namespace

void check_light_cuts(Device& device, CheckResult& result) {
    const CutCase data = make_cut_case(device);
    LightCuts cuts(device);
    const CutTree tree = cuts.make_tree(data.vpls.buffer(), data.vpls.count());
    check_nodes(data, tree, result);
    check_mean(device, data, cuts, tree, result);
}

}  // namespace nearlight::core
