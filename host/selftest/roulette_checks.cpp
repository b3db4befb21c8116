// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>
#include <vector>

#include "host/reference/gather_workload.h"
#include "host/reference/roulette_oracle.h"
#include "host/reference/synthetic_scene.h"
#include "host/selftest/checks.h"
#include "host/stages/gatherer.h"
#include "host/stages/roulette.h"

namespace nearlight::core {
namespace {

constexpr float kRouletteRadius = 0.05f;
constexpr float kThreshold = 2.0f;
constexpr uint kSeeds = 100;
/// Number of standard errors that chance does not reach in thousands of cases.
constexpr double kMaxDeviations = 5.5;

struct RouletteCase {
    std::vector<Vpl> vpls;
    std::vector<ReceiverPacket> receivers;
    DeviceTree tree;
    Buffer<Vpl> vpl_buffer;
    Buffer<ReceiverPacket> receiver_buffer;

    [[nodiscard]] GatherInput<Vpl> input(const VplSelection* selection) const {
        return {.tree = tree,
                .vpls = vpl_buffer,
                .vpl_count = vpls.size(),
                .receivers = receiver_buffer,
                .packet_count = receivers.size(),
                .clamp_radius = kRouletteRadius,
                .selection = selection};
    }
    [[nodiscard]] RouletteTask task(uint seed) const {
        return {.vpls = vpl_buffer,
                .vpl_count = vpls.size(),
                .receivers = receiver_buffer,
                .packet_count = receivers.size(),
                .clamp_radius = kRouletteRadius,
                .threshold = kThreshold,
                .seed = seed};
    }
};

RouletteCase make_case(Device& device) {
    const Scene scene = make_sphere_room(3000);
    const Bvh bvh = build_scene_bvh(scene);
    RouletteCase data;
    data.vpls = make_traced_vpls(scene, bvh, 150);
    for (std::size_t i = 0; i < data.vpls.size(); ++i) {
        data.vpls[i].power = Vec3{0.5f, 1.0f, 2.0f} * (1.0f + static_cast<float>(i % 7));
    }
    data.receivers = make_camera_receivers(scene, bvh, 40, 24);
    data.tree = upload_tree(device, bvh);
    data.vpl_buffer = {device, data.vpls};
    data.receiver_buffer = {device, data.receivers};
    return data;
}

/// Compares how often each bundle chose each VPL, and its weight, with the probabilities.
void check_choices(Device& device, const RouletteCase& data, CheckResult& result) {
    const BundleLayout layout = data.input(nullptr).bundles();
    std::vector<uint> chosen(layout.bundle_count() * data.vpls.size());
    std::vector<float> chosen_weights(chosen.size());
    Roulette roulette(device);
    for (uint seed = 0; seed < kSeeds; ++seed) {
        const VplSelection selection = roulette.select(data.task(seed));
        const VplLists& lists = selection.lists(0, layout.bundle_count());
        const std::vector<uint> vpls = lists.vpls.download();
        const std::vector<float> weights = lists.weights.download();
        const std::vector<uint> counts = lists.lengths.download();
        for (uint bundle = 0; bundle < layout.bundle_count(); ++bundle) {
            const std::size_t first = bundle * data.vpls.size();
            for (std::size_t k = first; k < first + counts[bundle]; ++k) {
                ++chosen[first + vpls[k]];
                chosen_weights[first + vpls[k]] = weights[k];
            }
        }
    }
    for (uint bundle = 0; bundle < layout.bundle_count(); ++bundle) {
        const std::vector<double> probabilities = roulette_probabilities(
            data.vpls, data.receivers, layout.bundle(bundle), kRouletteRadius, kThreshold);
        for (std::size_t vpl = 0; vpl < probabilities.size(); ++vpl) {
            const double p = probabilities[vpl];
            const double count = chosen[bundle * data.vpls.size() + vpl];
            const double weight = chosen_weights[bundle * data.vpls.size() + vpl];
            // Rounding may move a probability that is almost 0 or almost 1 to either side of that limit.
            const double chance = kMaxDeviations * std::sqrt(kSeeds * p * (1 - p)) + (p > 0 && p < 1 ? 2 : 0);
            result.expect(std::abs(count - p * kSeeds) <= chance &&
                          (count == 0 || std::abs(weight * p - 1) <= 1e-3));
        }
    }
}

/// The sums over all receivers and channels of each packet.
std::vector<double> sums_of_packets(const Buffer<IrradiancePacket>& irradiance) {
    std::vector<double> sums;
    for (const IrradiancePacket& packet : irradiance.download()) {
        sums.push_back(std::accumulate(packet.r, packet.r + 3 * NEARLIGHT_PACKET_SIZE, 0.0));
    }
    return sums;
}

void check_expectation(Device& device, const RouletteCase& data, CheckResult& result) {
    Gatherer gatherer(device);
    Roulette roulette(device);
    GatherSums<Vpl> sums(device, data.receivers.size());
    gatherer.gather(data.input(nullptr), sums);
    const std::vector<double> full = sums_of_packets(sums.light);
    std::vector<double> deviation(full.size());  // sum over the seeds
    std::vector<double> squares(full.size());
    for (uint seed = 0; seed < kSeeds; ++seed) {
        const VplSelection selection = roulette.select(data.task(seed));
        gatherer.gather(data.input(&selection), sums);
        const std::vector<double> some = sums_of_packets(sums.light);
        for (std::size_t packet = 0; packet < full.size(); ++packet) {
            deviation[packet] += some[packet] - full[packet];
            squares[packet] += (some[packet] - full[packet]) * (some[packet] - full[packet]);
        }
    }
    for (std::size_t packet = 0; packet < full.size(); ++packet) {
        const double mean = deviation[packet] / kSeeds;
        const double error = std::sqrt((squares[packet] / kSeeds - mean * mean) / (kSeeds - 1));
        result.expect(std::abs(mean) <= kMaxDeviations * error + 1e-6 * full[packet]);
    }
}

}  // namespace

void check_roulette(Device& device, CheckResult& result) {
    const RouletteCase data = make_case(device);
    check_choices(device, data, result);
    check_expectation(device, data, result);
}

}  // namespace nearlight::core
