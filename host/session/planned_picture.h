// SPDX-License-Identifier: Apache-2.0
// Pictures that are ready to be gathered, by the session's devices and by those of other processes.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "host/session/band_sharing.h"
#include "host/session/remote_devices.h"

namespace nearlight::core {

/// A picture with its plan. If there are remote devices, they know it.
struct PlannedPicture {
    PictureTask task;
    PixelWindow window{};                  ///< the part that is wanted
    std::optional<PictureNumber> shown{};  ///< its number, if it was shown to remote devices
    /// The bands, from the first one on, that remote devices were told to make before the picture's turn: the
    /// number of a device for each.
    std::vector<std::size_t> begun{};
};

/// Two pictures that follow one another.
struct PictureSequence {
    std::shared_ptr<PlannedPicture> present{};  ///< null: it is planned now
    /// Makes and plans the next picture while remote devices make the present one. When they have no band
    /// left, they go on with the next. Null: there is none yet.
    std::function<std::shared_ptr<PlannedPicture>()> next{};
};

/// The picture after the present one. Remote devices begin bands of it before anybody waits for them.
class NextPicture {
  public:
    /// Has a worker make the picture before it takes bands.
    void prepare_by(BandWorker& worker, std::function<std::shared_ptr<PlannedPicture>()> make);
    /// Has a remote device begin a band, if the picture is there and has one.
    void begin_band(const RemoteDevices& remote, std::size_t device);

  private:
    std::mutex mutex_;
    std::shared_ptr<PlannedPicture> picture_;
};

/// Adds a worker for each remote device, which knows the picture, to `workers`. They begin bands of `next`
/// when they have none left. Keeps references to `remote` and `next`.
void add_remote_workers(const RemoteDevices& remote, const PlannedPicture& picture, NextPicture& next,
                        std::vector<BandWorker>& workers);

}  // namespace nearlight::core
