// SPDX-License-Identifier: Apache-2.0
// The mean of several passes, and how far off it probably is.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Averages passes, for which it keeps the whole picture in memory. A column of the table in
/// kernels/shared/film_layers.h says which layers are averaged and which are those of pass 0.
///
/// The variance of the mean is judged in two ways. Each pass brings a variance of its own, which compares its
/// samples; it knows every pixel well, but not what all samples of a pass share, above all the set of VPLs.
/// The spread of the passes knows that, but few passes say little about one pixel. So the passes' own
/// variances are multiplied by the one factor with which they agree with the spread over the whole picture,
/// and each pixel takes the mean of both, in which the spread counts as many times as there are passes but
/// one.
class PassAverage {
  public:
    PassAverage(uint width, uint height);

    /// Begins a pass: the next rows are the topmost again. Its light has the given weight in the mean, in
    /// proportion to its number of samples.
    void begin_pass(float weight = 1.0f);
    /// Adds further rows of the present pass, from top to bottom, with the channels of layer_channels().
    void add_rows(std::span<const float> rows);

    /// The error of the mean as relative_error() has it.
    [[nodiscard]] double error() const;
    /// How many passes it takes before error() says something: few pixels may be alike by chance.
    [[nodiscard]] uint telling_passes() const;
    /// Sends the mean of the passes that reached each row. Rows that no pass reached are not sent.
    void send(const std::function<void(std::span<const float> rows)>& sink) const;

  private:
    struct Row {
        uint passes = 0;      ///< that reached it
        float weight = 0.0f;  ///< of these passes together
    };

    void add_row(std::size_t y, std::span<const float> values);
    void add_spread(std::size_t y, std::span<const float> values);
    [[nodiscard]] float mean_of(std::size_t y, std::size_t index) const;
    [[nodiscard]] std::size_t reached_rows() const;
    [[nodiscard]] std::vector<float> beauty() const;
    [[nodiscard]] std::vector<float> variances(std::span<const float> norms) const;
    [[nodiscard]] std::vector<float> own_variances() const;
    [[nodiscard]] std::vector<float> spread_variances() const;

    uint width_;
    std::size_t row_size_;  ///< floats
    /// Weighted sums of averaged layers, sums of squared weight × variance, and values of pass 0 for the
    /// other layers. A row that one pass has reached holds this pass's values, without a weight.
    std::vector<float> sums_;
    std::vector<float> spread_;  ///< R, G and B of each pixel: weighted sums of squares about the mean
    std::vector<Row> rows_;
    std::size_t end_ = 0;  ///< number of rows that the present pass has added
    float weight_ = 1.0f;  ///< of the present pass
};

}  // namespace nearlight::core
