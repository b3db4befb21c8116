// SPDX-License-Identifier: Apache-2.0
// How much of a rendered picture to keep beside what a denoiser made of it.
#pragma once

#include <span>
#include <vector>

namespace nearlight::core {

/// A picture before and after it was denoised: packed RGB, row after row. All numbers but those of `variance`
/// are finite.
struct DenoisedPair {
    int width = 0;
    int height = 0;
    std::span<const float> rendered;
    std::span<const float> denoised;
    std::span<const float> variance;  ///< an estimate, of `rendered`; +∞ where nothing is known of it
};

/// For each pixel the share of `rendered`, in [0, 1], in the mixture of both pictures that has about the
/// least squared error. It is 0 where noise explains what the denoiser changed, and close to 1 where it does
/// not, because there the denoiser took detail for noise.
///
/// A value R has the variance V, and its denoised one D has the error B and hardly any noise. Then s·R + (1 −
/// s)·D has the least expected squared error if s = B² ÷ (B² + V). Since (R − D)² is B² + V in the mean, s is
/// 1 − V ÷ (R − D)², with sums over a window in place of both, as in shrinkage [James & Stein 1961].
std::vector<float> rendered_shares(const DenoisedPair& pair);

}  // namespace nearlight::core
