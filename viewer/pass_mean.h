// SPDX-License-Identifier: Apache-2.0
// The mean of the passes of one picture.
#pragma once

#include "nearlight/image.h"

namespace nearlight::viewer {

/// Averages light, by the samples that passes have, and keeps what the first pass says of the surfaces.
class PassMean {
  public:
    /// Forgets all passes.
    void clear() { samples_ = 0; }
    /// Adds a pass of `samples` samples per pixel. The first pass after clear() decides size and channels,
    /// which all others must have too.
    void add(const Image& pass, unsigned samples);
    /// The mean of all passes. There must be one.
    [[nodiscard]] const Image& image() const { return mean_; }
    /// Samples per pixel in all passes together.
    [[nodiscard]] unsigned samples() const { return samples_; }

  private:
    Image mean_;
    unsigned samples_ = 0;
};

/// Whether a channel is light, as those of `beauty`, `direct` and `indirect` are.
bool is_light(const std::string& channel);

}  // namespace nearlight::viewer
