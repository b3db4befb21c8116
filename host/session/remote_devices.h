// SPDX-License-Identifier: Apache-2.0
// Devices of other processes, which make bands of a session's pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/session/band_renderer.h"

namespace nearlight::core {

/// The number of a picture among those that were shown to remote devices.
using PictureNumber = std::uint64_t;

struct RemoteDevice {
    std::size_t number = 0;           ///< by which RemoteDevices calls it
    std::string name;                 ///< for messages
    std::size_t batch_receivers = 0;  ///< receivers_per_batch() of the device
};

/// What a session asks of remote devices. Each has the session's scene. The functions may be called from
/// several threads.
struct RemoteDevices {
    std::vector<RemoteDevice> devices;
    /// Gives all of them a picture and its VPLs, which is not waited for.
    std::function<PictureNumber(const PictureTask&, std::span<const Vpl>)> show;
    /// Has a device make a band, which is not waited for. It makes its bands in the order of the calls.
    std::function<void(PictureNumber, std::size_t device, uint band)> order;
    /// Waits for a band, and orders it before unless it has been. Returns nothing if the progress stopped it.
    /// Throws Error if the device has failed.
    std::function<std::optional<FinishedBand>(PictureNumber, std::size_t device, uint band,
                                              const WorkProgress&)>
        fetch;
    /// Ends work on a picture. What has been ordered of it and was not fetched is lost.
    std::function<void(PictureNumber)> end;
};

}  // namespace nearlight::core
