// SPDX-License-Identifier: Apache-2.0
// The mean of several passes, and how far off it probably is.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "host/session/pass_sums.h"
#include "kernels/shared/types.h"

namespace nearlight::core {

/// Averages passes. A column of the table in kernels/shared/film_layers.h says which layers are averaged and
/// which are those of the first pass that is added.
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
    /// Goes on from the sums of earlier passes. If the last of them reached only `begun_rows`, it has
    /// `begun_samples` per pixel, and the next rows are those below.
    explicit PassAverage(PassSums sums, uint begun_samples = 0, std::size_t begun_rows = 0);

    /// Begins a pass: the next rows are the topmost again. Its light has the number of its samples per pixel
    /// as a weight in the mean.
    void begin_pass(uint samples = 1);
    /// Adds further rows of the present pass, from top to bottom, with the channels of layer_channels().
    void add_rows(std::span<const float> rows);

    /// The error of the mean as relative_error() has it.
    [[nodiscard]] double error() const;
    /// How many passes it takes before error() says something: few pixels may be alike by chance.
    [[nodiscard]] uint telling_passes() const;
    /// Sends the mean of the passes that reached each row. Rows that no pass reached are not sent.
    void send(const std::function<void(std::span<const float> rows)>& sink) const;

    [[nodiscard]] const PassSums& sums() const { return sums_; }
    /// How many rows the present pass has added.
    [[nodiscard]] std::size_t begun_rows() const { return end_; }

  private:
    template <typename Value>
    [[nodiscard]] std::vector<float> colors(const Value& value) const;
    [[nodiscard]] std::size_t reached_rows() const;
    [[nodiscard]] std::vector<float> beauty() const;
    [[nodiscard]] std::vector<float> variances(std::span<const float> norms) const;
    [[nodiscard]] std::vector<float> own_variances() const;
    [[nodiscard]] std::vector<float> spread_variances() const;

    PassSums sums_;
    std::size_t end_ = 0;  ///< number of rows that the present pass has added
    uint samples_ = 1;     ///< per pixel, of the present pass
};

}  // namespace nearlight::core
