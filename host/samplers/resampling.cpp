// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/resampling.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>

#include "host/base/math.h"

namespace nearlight::core {

namespace {

bool usable(float weight) {
    return weight > 0.0f && std::isfinite(weight);
}

/// Finds τ for which Σ min(1, weight / τ) = wanted; 0 if there are no more than `wanted` usable weights.
double threshold(std::span<const float> weights, std::size_t wanted) {
    std::vector<float> descending;
    std::ranges::copy_if(weights, std::back_inserter(descending), usable);
    if (descending.size() <= wanted) {
        return 0.0;
    }
    double rest = std::accumulate(descending.begin(), descending.end(), 0.0);
    const auto asked = descending.begin() + static_cast<std::ptrdiff_t>(wanted);
    std::ranges::nth_element(descending, asked, std::greater());
    std::sort(descending.begin(), asked, std::greater());
    // The `sure` largest weights are chosen for certain; the other weights share the rest of `wanted` in
    // proportion.
    for (std::size_t sure = 0; sure < wanted; ++sure) {
        const double tau = rest / static_cast<double>(wanted - sure);
        if (descending[sure] <= tau) {
            return tau;
        }
        rest -= descending[sure];
    }
    return descending[wanted - 1];
}

}  // namespace

Probabilities choice_probabilities(std::span<const float> weights, std::size_t wanted) {
    Probabilities result{.of = std::vector<double>(weights.size())};
    if (wanted == 0) {
        return result;
    }
    result.tau = threshold(weights, wanted);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (usable(weights[i])) {
            result.of[i] = weights[i] < result.tau ? weights[i] / result.tau : 1.0;
        }
    }
    return result;
}

Choice resample(std::span<const float> weights, std::size_t wanted, double shift) {
    const std::vector<double> probabilities = choice_probabilities(weights, wanted).of;
    Choice choice;
    double sum = 0;
    double next_point = shift;
    for (std::size_t i = 0; i < probabilities.size(); ++i) {
        sum += probabilities[i];
        if (sum > next_point) {
            choice.indices.push_back(static_cast<uint>(i));
            choice.factors.push_back(static_cast<float>(1.0 / probabilities[i]));
            next_point += 1.0;
        }
    }
    return choice;
}

std::vector<Vpl> take(const Choice& choice, std::span<const Vpl> candidates) {
    std::vector<Vpl> vpls;
    vpls.reserve(choice.indices.size());
    for (std::size_t i = 0; i < choice.indices.size(); ++i) {
        vpls.push_back(candidates[choice.indices[i]]);
        vpls.back().power = vpls.back().power * choice.factors[i];
    }
    return vpls;
}

}  // namespace nearlight::core
