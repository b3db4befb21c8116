// SPDX-License-Identifier: Apache-2.0
// The sums of several passes of a picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/session/double_sum.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {

/// Adds passes up, each with its number of samples as a weight, and keeps the whole picture in memory. The
/// sums have 106 bits. So they are the same in whatever order passes come, and the sums of some passes can be
/// added to those of others. Where the light of a pixel differs by a factor of more than a million between
/// passes, the last of the 106 bits may depend on the order; a picture has 24 of them.
class PassSums {
  public:
    /// Channels that are averaged; each has a sum.
    static constexpr std::size_t kMeans = channels_with(PassRule::mean);
    /// Colours of the beauty: each has a sum of the passes' own variances, and one of its squares.
    static constexpr std::size_t kVariances = channels_with(PassRule::variance);
    /// Sums of a pixel: of the averaged channels, then of the variances, then of the squares.
    static constexpr std::size_t kSums = kMeans + 2 * kVariances;
    /// Channels that stay those of the first pass.
    static constexpr std::size_t kFirsts = channels_with(PassRule::first);
    static_assert(kVariances == NEARLIGHT_CHANNELS_RGB);

    /// What has been added to a row.
    struct Row {
        std::uint32_t passes = 0;
        std::uint64_t samples = 0;  ///< per pixel, of these passes together
    };

    PassSums(std::size_t width, std::size_t height);

    /// Adds row `y` of a pass of `samples` per pixel, with the channels of layer_channels().
    void add_row(std::size_t y, std::span<const float> values, std::uint32_t samples);
    /// Adds the passes of a picture of the same size. Layers that are not averaged stay those of this one in
    /// rows that have any pass.
    void add(const PassSums& other);

    [[nodiscard]] std::size_t width() const { return width_; }
    [[nodiscard]] std::size_t height() const { return rows_.size(); }
    [[nodiscard]] const Row& row(std::size_t y) const { return rows_[y]; }

    /// The value of channel `channel` of a pixel: the mean, or that of the first pass, or, for variances, the
    /// passes' own variance of the mean.
    [[nodiscard]] float value(std::size_t x, std::size_t y, std::size_t channel) const;
    /// The variance of the mean of colour `color` of the beauty, by the spread of the passes; 0 in rows that
    /// one pass has reached.
    [[nodiscard]] float spread_variance(std::size_t x, std::size_t y, std::size_t color) const;

    /// The state as it is kept in files: kSums sums and kFirsts values for each pixel, and the rows.
    [[nodiscard]] std::span<DoubleSum> sums() { return sums_; }
    [[nodiscard]] std::span<const DoubleSum> sums() const { return sums_; }
    [[nodiscard]] std::span<float> firsts() { return firsts_; }
    [[nodiscard]] std::span<const float> firsts() const { return firsts_; }
    [[nodiscard]] std::span<Row> rows() { return rows_; }

  private:
    [[nodiscard]] const DoubleSum& sum(std::size_t x, std::size_t y, std::size_t index) const {
        return sums_[(y * width_ + x) * kSums + index];
    }

    std::size_t width_;
    std::vector<DoubleSum> sums_;
    std::vector<float> firsts_;
    std::vector<Row> rows_;
};

}  // namespace nearlight::core
