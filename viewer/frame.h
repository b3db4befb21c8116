// SPDX-License-Identifier: Apache-2.0
// What the renderer makes for the window.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "nearlight/session.h"

namespace nearlight::viewer {

/// A picture that can be shown.
struct Frame {
    Image image{};  ///< with the channels of picture_channels()
    /// The image with its indirect light averaged over neighbouring pixels, while it has few samples and more
    /// are to come. For the eye only: files and other programs get the image itself.
    std::optional<Image> smoothed{};
    std::optional<View> view{};  ///< what it shows, at its own size
    /// The VPLs of its latest pass, on the device and on the host.
    std::optional<VplSet> vpls{};
    std::shared_ptr<const std::vector<VirtualPointLight>> lights{};
    std::uint64_t state = 0;  ///< Step::state of the step that made it
    int divisor = 1;          ///< above 1, it is a small picture, made during a motion
    /// Per pixel, in all passes; 0 for small pictures and for the first one, which the first pass replaces.
    std::uint32_t samples = 0;
    double seconds = 0.0;          ///< that its latest step took
    double seconds_to_full = 0.0;  ///< from the latest change to its first picture of full size; 0 before

    /// What a window shows.
    [[nodiscard]] const Image& shown() const { return smoothed ? *smoothed : image; }
};

/// What lights the surface that a pixel shows. Light is irradiance in W/m².
struct Inspection {
    int x = 0;  ///< pixel of the frame, from the left
    int y = 0;  ///< from the top
    bool hits_surface = false;
    Vec3 position{};
    Vec3 normal{};
    std::vector<LightShare> shares{};
    Vec3 direct{};     ///< from emitters
    Vec3 from_vpls{};  ///< from VPLs, under the clamp radius
    Vec3 clamped{};    ///< what the clamp radius takes away from these VPLs
    Vec3 remainder{};  ///< what rays of the receiver bring
};

/// Finds out what lights a pixel of a frame. For the thread that uses the session.
Inspection inspect(Session& session, const Frame& frame, int x, int y);

}  // namespace nearlight::viewer
