// SPDX-License-Identifier: Apache-2.0
// Several renderings of one view, which differ in their random numbers only: how many, and their mean.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/base/stopwatch.h"
#include "kernels/shared/types.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// Of pass 0, 1, … of a picture with that seed: pass 0 has the seed itself, the others mix it with the pass,
/// so that pictures of neighbouring seeds share none.
uint pass_seed(uint seed, uint pass);

/// Whether there is to be another pass, and how far all of them are.
class PassClock {
  public:
    /// `seconds` were spent already, on getting ready.
    PassClock(const RenderSettings& settings, double seconds);

    /// To be asked after each pass.
    [[nodiscard]] bool has_another();
    /// Of all passes, 0 to 1, where the present one has come so far.
    [[nodiscard]] double fraction(double of_pass) const;

  private:
    uint passes_;
    std::optional<double> seconds_;
    double seconds_before_;
    Stopwatch watch_;
    uint done_ = 0;
};

/// Keeps the whole picture. Which layers are averaged and which are those of pass 0 is a column of the
/// table in kernels/shared/film_layers.h.
class PassAverage {
  public:
    PassAverage(uint width, uint height);

    /// Further rows of the present pass, top to bottom: channels as layer_channels() names them.
    void add_rows(std::span<const float> rows);
    /// The next rows are again the topmost.
    void begin_pass() { end_ = 0; }

    /// Sends each row divided by the number of passes that reached it; none of those that no pass reached.
    void send(const std::function<void(std::span<const float> rows)>& sink) const;

  private:
    std::size_t row_size_;          ///< floats
    std::vector<float> sums_;       ///< of the layers that are averaged; the others as they came
    std::vector<uint> row_passes_;  ///< that reached each row
    std::size_t end_ = 0;           ///< of the present pass, floats
};

}  // namespace nearlight::core
