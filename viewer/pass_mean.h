// SPDX-License-Identifier: Apache-2.0
// The mean of the passes of one picture.
#pragma once

#include <string_view>

#include "nearlight/image.h"

namespace nearlight::viewer {

/// Averages light and coverage, and keeps what the first pass says of the surfaces. The layer `variance` has
/// no meaning here.
class PassMean {
  public:
    /// Forgets all passes.
    void clear() { passes_ = 0; }
    /// Adds a pass. The first one after clear() decides size and channels, which all others must have too.
    void add(const Image& pass);
    /// The mean of all passes. There must be one.
    [[nodiscard]] const Image& image() const { return mean_; }
    [[nodiscard]] unsigned passes() const { return passes_; }

  private:
    Image mean_;
    unsigned passes_ = 0;
};

/// Whether the mean of passes is the mean of this channel, as of those of `beauty`, `direct`, `indirect` and
/// `A`.
bool is_averaged(std::string_view channel);

}  // namespace nearlight::viewer
