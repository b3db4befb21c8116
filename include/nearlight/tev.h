// SPDX-License-Identifier: Apache-2.0
// Pictures for the image viewer tev.
#pragma once

#include <memory>
#include <string>

#include "nearlight/export.h"
#include "nearlight/image.h"

namespace nearlight {

/// A connection to the image viewer tev (https://github.com/Tom94/tev). For one thread at a time.
class NEARLIGHT_API TevLink {
  public:
    /// Connects to a tev at "HOST:PORT", or at "HOST" or "[IPv6]:PORT"; the usual port is 14158. Throws
    /// Error: ErrorKind::invalid_argument for another form, ErrorKind::failure if nobody listens there.
    explicit TevLink(const std::string& address);
    ~TevLink();
    TevLink(TevLink&&) noexcept;
    TevLink& operator=(TevLink&&) noexcept;

    /// Shows a picture under a name. A later picture of the same name, size and channels replaces its pixels.
    /// Throws Error: ErrorKind::invalid_argument for an image without pixels or channels, or whose values do
    /// not fit its size; ErrorKind::failure if tev no longer takes anything, because it is gone or has read
    /// nothing for 2 s.
    void show(const std::string& name, const Image& image);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nearlight
