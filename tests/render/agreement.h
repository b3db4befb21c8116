// SPDX-License-Identifier: Apache-2.0
// Comparison of the renderer with the Embree path tracer, which shares no sampling code with it: same
// definition, same picture.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "host/reference/path_tracer.h"
#include "tests/render/rendering.h"
#include "tests/support/small_scenes.h"

namespace nearlight::test {

/// Pictures are square, so many pixels wide.
inline constexpr int kAgreementSize = 48;

inline RenderSettings agreement_settings(SamplerKind sampler, float clamp_radius, uint seed,
                                         Policy policy = Policy::partition) {
    return {.sampler = sampler,
            .policy = policy,
            .vpl_count = 4000,
            .clamp_radius = clamp_radius,
            .max_depth = 6,
            .samples_per_pixel = 4,
            .direct_samples_per_pixel = 128,
            .seed = seed};
}

/// Mean of the pixels [x0, x1) × [y0, y1) of a channel.
inline double region_mean(const Image& image, const std::string& channel, int block) {
    const int blocks = 4;
    const int size = kAgreementSize / blocks;
    const auto index = static_cast<std::size_t>(image.find_channel(channel));
    double sum = 0;
    for (int y = block / blocks * size; y < (block / blocks + 1) * size; ++y) {
        for (int x = block % blocks * size; x < (block % blocks + 1) * size; ++x) {
            sum += image.at(x, y, index);
        }
    }
    return sum / (size * size);
}

/// Mean and standard error over several renders.
struct Estimate {
    double mean = 0;
    double error = 0;
};
inline Estimate estimate(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double sum = 0;
    double squares = 0;
    for (const double value : values) {
        sum += value;
        squares += value * value;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

/// Standard error of the reference's mean over a block, or (block < 0) the whole picture, by its own variance layers;
/// that of the beauty bounds that of its direct part.
inline double reference_error(const Image& reference, const std::string& channel, int block) {
    const std::string color = channel.substr(channel.find('.'));
    const std::string layer = (channel.starts_with("indirect") ? "indirectVariance" : "variance") + color;
    const double pixels = kAgreementSize * kAgreementSize;
    return block < 0 ? std::sqrt(small_scenes::channel_mean(reference, layer) / pixels)
                     : std::sqrt(region_mean(reference, layer, block) / (pixels / 16));
}

/// Several seeds give the renderer's own spread, so the bounds are statistical: 6 standard errors of renderer and
/// reference together (Student's t with 11 degrees of freedom: a false alarm in 10⁴ comparisons) for each of 16 blocks
/// of the picture, 5 for the whole. A block of a few pixels that is lit by rare paths has a distribution with a long
/// tail, for which a variance from as few batches says too little; 0.4 % of the value is granted for that.
inline void expect_agreement(Device& device, const Scene& scene, SamplerKind sampler, float clamp_radius,
                             Policy policy = Policy::partition) {
    constexpr uint kSeeds = 12;
    const Image reference =
        trace_paths(scene, {.spp = 512, .max_depth = 6, .clamp_radius = clamp_radius, .seed = 9});
    std::vector<Image> images;
    for (uint seed = 0; seed < kSeeds; ++seed) {
        images.push_back(
            render_image(device, scene, agreement_settings(sampler, clamp_radius, 100 + seed, policy)).image);
    }
    for (const std::string channel : {"direct.R", "direct.B", "indirect.R", "indirect.G", "indirect.B"}) {
        std::vector<double> means;
        for (const Image& image : images) {
            means.push_back(small_scenes::channel_mean(image, channel));
        }
        const double expected_mean = small_scenes::channel_mean(reference, channel);
        const Estimate whole = estimate(means);
        const double error = std::hypot(whole.error, reference_error(reference, channel, -1));
        EXPECT_NEAR(whole.mean, expected_mean, 5 * error + 0.002 * expected_mean) << channel;
        EXPECT_LT(error, 0.015 * expected_mean) << channel << ": too noisy to tell anything";
        for (int block = 0; block < 16; ++block) {
            std::vector<double> values;
            for (const Image& image : images) {
                values.push_back(region_mean(image, channel, block));
            }
            const double expected = region_mean(reference, channel, block);
            const Estimate found = estimate(values);
            const double block_error =
                std::hypot(found.error, reference_error(reference, channel, block), 0.004 * expected);
            EXPECT_NEAR(found.mean, expected, 6 * block_error + 1e-6) << channel << " block " << block;
        }
    }
}

}  // namespace nearlight::test
