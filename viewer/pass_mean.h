// SPDX-License-Identifier: Apache-2.0
// The mean of the passes of one picture.
#pragma once

#include <string_view>

#include "nearlight/image.h"

namespace nearlight::viewer {

/// Averages light, coverage and albedo. The layer `variance` has no meaning here.
class PassMean {
  public:
    /// Begins the mean of a picture. What layers say of surfaces stays as in `first`, whose samples go
    /// through the middles of pixels, because those of passes lie somewhere about them.
    void begin(const Image& first);
    /// Adds a pass, which must have the size and the channels of the first picture.
    void add(const Image& pass);
    /// The mean of all passes. There must be one.
    [[nodiscard]] const Image& image() const { return mean_; }
    [[nodiscard]] unsigned passes() const { return passes_; }

  private:
    Image mean_;
    unsigned passes_ = 0;
};

/// Whether the mean of passes is the mean of this channel, as of those of `beauty`, `direct`, `indirect`, `A`
/// and `albedo`. The light of a pass belongs to its own albedo, by which smooth_interleaved() divides.
bool is_averaged(std::string_view channel);

}  // namespace nearlight::viewer
