// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/resampling.h"

#include <cmath>

#include "host/base/math.h"

namespace nearlight {

Choice resample(std::span<const float> weights, std::size_t wanted, double shift) {
    const auto usable = [](float weight) { return weight > 0.0f && std::isfinite(weight); };
    double total = 0;
    for (const float weight : weights) {
        total += usable(weight) ? weight : 0.0;
    }
    Choice choice;
    if (!(total > 0.0) || wanted == 0) {
        return choice;
    }
    const double per_weight = static_cast<double>(wanted) / total;
    double sum = 0;
    auto points_before = static_cast<std::int64_t>(0);  // points shift, shift + 1, … that lie below the running sum
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!usable(weights[i])) {
            continue;
        }
        const double expected = weights[i] * per_weight;
        sum += expected;
        const auto points = static_cast<std::int64_t>(std::ceil(sum - shift));
        if (points > points_before) {
            choice.indices.push_back(static_cast<uint>(i));
            choice.factors.push_back(static_cast<float>(static_cast<double>(points - points_before) / expected));
            points_before = points;
        }
    }
    return choice;
}

std::vector<Vpl> apply(const Choice& choice, std::span<const Vpl> candidates) {
    std::vector<Vpl> vpls;
    vpls.reserve(choice.indices.size());
    for (std::size_t i = 0; i < choice.indices.size(); ++i) {
        vpls.push_back(candidates[choice.indices[i]]);
        vpls.back().power = vpls.back().power * choice.factors[i];
    }
    return vpls;
}

}  // namespace nearlight
