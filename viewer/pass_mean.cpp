// SPDX-License-Identifier: Apache-2.0
#include "viewer/pass_mean.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace nearlight::viewer {

bool is_averaged(std::string_view channel) {
    static constexpr std::array<std::string_view, 5> kLayers{"beauty", "direct", "indirect", "A", "albedo"};
    return std::ranges::find(kLayers, layer_of(channel)) != kLayers.end();
}

void PassMean::begin(const Image& first) {
    mean_ = first;
    passes_ = 0;
}

void PassMean::add(const Image& pass) {
    ++passes_;
    const float weight = 1.0f / static_cast<float>(passes_);
    std::vector<std::size_t> averaged;
    for (std::size_t channel = 0; channel < pass.channels.size(); ++channel) {
        if (is_averaged(pass.channels[channel])) {
            averaged.push_back(channel);
        }
    }
    const std::size_t stride = pass.channels.size();
    for (std::size_t pixel = 0; pixel < pass.values.size(); pixel += stride) {
        for (const std::size_t channel : averaged) {
            float& mean = mean_.values[pixel + channel];
            const float value = pass.values[pixel + channel];
            mean = passes_ == 1 ? value : mean + weight * (value - mean);
        }
    }
}

}  // namespace nearlight::viewer
