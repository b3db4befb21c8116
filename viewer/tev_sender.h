// SPDX-License-Identifier: Apache-2.0
// Sends pictures to the image viewer tev in a thread of its own, because the network may be slow.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "nearlight/image.h"
#include "nearlight/tev.h"

namespace nearlight::viewer {

/// All functions are for the thread that made it.
class TevSender {
  public:
    /// Connects to a tev at "HOST:PORT", which will show pictures under this name. Throws as TevLink does.
    TevSender(const std::string& address, std::string name);
    /// Sends the latest picture before it ends.
    ~TevSender() = default;
    TevSender(const TevSender&) = delete;
    TevSender& operator=(const TevSender&) = delete;

    /// Sends a picture. While an earlier one is on its way, only the latest one waits.
    void send(Image image);
    /// Why nothing is sent any more; empty if all is well.
    [[nodiscard]] std::string error() const;

  private:
    void run(const std::stop_token& stopping);

    TevLink link_;
    const std::string name_;
    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    // The mutex guards the next two.
    std::optional<Image> waiting_;
    std::string error_;
    std::jthread thread_;  ///< declared last, because it uses the others
};

}  // namespace nearlight::viewer
