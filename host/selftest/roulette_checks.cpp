// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "host/reference/roulette_oracle.h"
#include "host/selftest/selection_checks.h"
#include "host/stages/roulette.h"

namespace nearlight::core {
namespace {

constexpr float kThreshold = 2.0f;
constexpr uint kSeeds = 100;
/// Number of standard errors that chance does not reach in thousands of cases.
constexpr double kMaxDeviations = 5.5;

RouletteTask task_of(const SelectionCase& data, uint seed) {
    return {.vpls = data.vpl_buffer,
            .vpl_count = data.vpls.size(),
            .receivers = data.receiver_buffer,
            .packet_count = data.receivers.size(),
            .clamp_radius = SelectionCase::kClampRadius,
            .threshold = kThreshold,
            .seed = seed};
}

/// Compares how often each bundle chose each VPL, and its weight, with the probabilities.
void check_choices(Device& device, const SelectionCase& data, CheckResult& result) {
    const BundleLayout layout = data.input(nullptr).bundles();
    std::vector<uint> chosen(layout.bundle_count() * data.vpls.size());
    std::vector<float> chosen_weights(chosen.size());
    Roulette roulette(device);
    for (uint seed = 0; seed < kSeeds; ++seed) {
        const VplSelection selection = roulette.select(task_of(data, seed));
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
            data.vpls, data.receivers, layout.bundle(bundle), SelectionCase::kClampRadius, kThreshold);
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

void check_expectation(Device& device, const SelectionCase& data, CheckResult& result) {
    Roulette roulette(device);
    SelectionMean mean(device, data);
    for (uint seed = 0; seed < kSeeds; ++seed) {
        mean.add(roulette.select(task_of(data, seed)));
    }
    mean.check(kMaxDeviations, result);
}

}  // namespace

void check_roulette(Device& device, CheckResult& result) {
    const SelectionCase data = make_selection_case(device, 150);
    check_choices(device, data, result);
    check_expectation(device, data, result);
}

}  // namespace nearlight::core
