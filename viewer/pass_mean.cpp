// SPDX-License-Identifier: Apache-2.0
#include "viewer/pass_mean.h"

#include <vector>

namespace nearlight::viewer {

bool is_light(const std::string& channel) {
    const std::string layer = channel.substr(0, channel.find('.'));
    return channel == "R" || channel == "G" || channel == "B" || layer == "direct" || layer == "indirect";
}

void PassMean::add(const Image& pass, unsigned samples) {
    if (samples_ == 0) {
        mean_ = pass;
        samples_ = samples;
        return;
    }
    samples_ += samples;
    const float weight = static_cast<float>(samples) / static_cast<float>(samples_);
    std::vector<std::size_t> light;
    for (std::size_t channel = 0; channel < pass.channels.size(); ++channel) {
        if (is_light(pass.channels[channel])) {
            light.push_back(channel);
        }
    }
    const std::size_t stride = pass.channels.size();
    for (std::size_t pixel = 0; pixel < pass.values.size(); pixel += stride) {
        for (const std::size_t channel : light) {
            float& mean = mean_.values[pixel + channel];
            mean += weight * (pass.values[pixel + channel] - mean);
        }
    }
}

}  // namespace nearlight::viewer
