// SPDX-License-Identifier: Apache-2.0
// Several renderings of one view, which differ only in their random numbers: their number and their mean.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/base/stopwatch.h"
#include "kernels/shared/types.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// The seed of a pass of a picture with the seed `seed`. Pass 0 has `seed` itself; the others mix it with
/// `pass`, so that pictures of neighbouring seeds share no pass.
uint pass_seed(uint seed, uint pass);

/// Decides whether there is another pass, and says how far all passes are.
class PassClock {
  public:
    /// `seconds` is the time that was already spent on getting ready.
    PassClock(const RenderSettings& settings, double seconds);

    /// Whether to begin another pass. Must be called once after each pass.
    [[nodiscard]] bool has_another();
    /// How far all passes are, from 0 to 1, if the present one is as far as `of_pass`, also from 0 to 1.
    [[nodiscard]] double fraction(double of_pass) const;

  private:
    uint passes_;
    std::optional<double> seconds_;
    double seconds_before_;
    Stopwatch watch_;
    uint done_ = 0;
};

/// Averages passes, for which it keeps the whole picture in memory. A column of the table in
/// kernels/shared/film_layers.h says which layers are averaged and which are those of pass 0.
class PassAverage {
  public:
    PassAverage(uint width, uint height);

    /// Adds further rows of the present pass, from top to bottom, with the channels of layer_channels().
    void add_rows(std::span<const float> rows);
    /// Begins a pass: the next rows are the topmost again.
    void begin_pass() { end_ = 0; }

    /// Sends each row divided by the number of passes that reached it. Rows that no pass reached are not
    /// sent.
    void send(const std::function<void(std::span<const float> rows)>& sink) const;

  private:
    std::size_t row_size_;          ///< floats
    std::vector<float> sums_;       ///< sums of averaged layers; values of pass 0 for the others
    std::vector<uint> row_passes_;  ///< number of passes that reached each row
    std::size_t end_ = 0;           ///< number of floats that the present pass has added
};

}  // namespace nearlight::core
