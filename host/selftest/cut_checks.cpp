// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "host/selftest/selection_checks.h"
#include "host/stages/light_cuts.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kAskedCount = 25;
constexpr uint kShifts = 100;
/// The maximum distance of the mean from the light of all VPLs, in standard errors of as many independent
/// shifts. Evenly spaced shifts come much closer.
constexpr double kMaxCutErrors = 2.0;

/// Whether a node's box, axis and spread hold a VPL.
bool holds(const CutNode& node, const Vpl& vpl) {
    const Vec3 p = vpl.position;
    const bool inside = p.x >= node.low.x && p.y >= node.low.y && p.z >= node.low.z && p.x <= node.high.x &&
                        p.y <= node.high.y && p.z <= node.high.z;
    return inside && length(vpl.normal - node.axis) <= node.spread + 1e-5f;
}

/// Compares the nodes of every level with the VPLs below them.
void check_nodes(const SelectionCase& data, const CutTree& tree, CheckResult& result) {
    const std::vector<CutNode> nodes = tree.nodes.download();
    const std::vector<Vpl>& vpls = data.vpls;
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

/// Compares the mean over many shifts with the light of all VPLs.
void check_mean_of_cuts(Device& device, const SelectionCase& data, LightCuts& cuts, const CutTree& tree,
                        CheckResult& result) {
    SelectionMean mean(device, data);
    for (uint shift = 0; shift < kShifts; ++shift) {
        const VplStrata strata(device, kShifts, std::vector{shift});
        mean.add(cuts.select({.vpls = data.vpl_buffer,
                              .tree = tree,
                              .receivers = data.receiver_buffer,
                              .packet_count = data.receivers.size(),
                              .strata = strata,
                              .clamp_radius = SelectionCase::kClampRadius,
                              .asked_count = kAskedCount * kShifts,
                              .seed = 1}));
    }
    mean.check(kMaxCutErrors, result);
}

}  // namespace

void check_light_cuts(Device& device, CheckResult& result) {
    const SelectionCase data = make_selection_case(device, 1000);
    LightCuts cuts(device);
    const CutTree tree = cuts.make_tree(data.vpl_buffer, data.vpls.size());
    check_nodes(data, tree, result);
    check_mean_of_cuts(device, data, cuts, tree, result);
}

}  // namespace nearlight::core
