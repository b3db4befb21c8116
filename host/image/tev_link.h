// SPDX-License-Identifier: Apache-2.0
// Sends pictures to the image viewer tev (https://github.com/Tom94/tev), which shows them while they are
// made. It listens on a TCP port for packets: their length in bytes, their kind, and what belongs to it, all
// in little-endian order.
#pragma once

#include <span>
#include <string>

#include "host/image/image.h"

namespace nearlight::core {

/// The port on which tev listens unless it is told otherwise.
inline constexpr const char* kTevPort = "14158";

class TevLink {
  public:
    /// Connects to a tev at "HOST:PORT", "HOST" or "[IPv6]:PORT". Throws Error(ErrorKind::invalid_argument)
    /// for another form, and Error(ErrorKind::failure) if nobody listens there.
    explicit TevLink(const std::string& address);
    ~TevLink();
    TevLink(const TevLink&) = delete;
    TevLink& operator=(const TevLink&) = delete;

    /// Makes a black picture of that name, which replaces one of the same name. Both functions throw
    /// Error(ErrorKind::failure) if tev no longer takes anything: if it is gone, or reads nothing for 2 s.
    void create(const std::string& name, int width, int height, std::span<const std::string> channels);
    /// Replaces whole rows of a picture that was created, from row `first` on. `values` are interleaved.
    void update(const std::string& name, int first, int width, std::span<const std::string> channels,
                std::span<const float> values);

  private:
    void send(std::span<const char> packet);

    std::string address_;
    int socket_ = -1;
};

}  // namespace nearlight::core
