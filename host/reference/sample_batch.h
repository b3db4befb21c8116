// SPDX-License-Identifier: Apache-2.0
// The random numbers of one batch of samples of a pixel.
#pragma once

#include <array>
#include <cstdint>

#include "host/base/random.h"
#include "host/reference/sampling.h"

namespace nearlight::core {

/// The decisions of a path that are stratified over a batch: those at its first two vertices. Later decisions
/// use independent random numbers.
enum class Decision {
    film,
    lens,
    first_part,  ///< x: which material of a mask or blend, y: which part of the BSDF
    first_lobe,  ///< x: which lobe of the part, y: which light
    first_direction,
    first_light,
    second_part,
    second_lobe,
    second_direction,
    second_light,
    count,
};

/// A batch of `size` samples (1, 4 or 16). Each decision has its own square grid of `size` cells with one
/// random point in each, dealt to the samples in random order. The samples of a batch depend on each other;
/// those of different batches do not. Every single point is uniform, so each sample is unbiased.
class SampleBatch {
  public:
    static constexpr int kMaxSize = 16;

    SampleBatch(std::uint64_t seed, std::uint64_t pixel, std::uint64_t batch, int size);

    [[nodiscard]] Point2 point(Decision decision, int sample) const {
        return points_[static_cast<std::size_t>(decision)][static_cast<std::size_t>(sample)];
    }
    [[nodiscard]] Pcg32& random() { return random_; }

  private:
    Pcg32 random_;
    std::array<std::array<Point2, kMaxSize>, static_cast<std::size_t>(Decision::count)> points_;
};

}  // namespace nearlight::core
