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
    Image image{};               ///< with the channels of picture_channels()
    std::optional<View> view{};  ///< what it shows, at its own size
    /// The VPLs of its latest pass, on the device and on the host.
    std::optional<VplSet> vpls{};
    std::shared_ptr<const std::vector<VirtualPointLight>> lights{};
    std::uint64_t state = 0;            ///< number of the request that it shows
    int divisor = 1;                    ///< above 1, it is a small picture, made during a motion
    bool is_quick = true;               ///< it is a small picture or the first one, which passes will replace
    bool is_smoothed = false;           ///< its light is averaged over neighbouring pixels
    std::uint32_t samples = 0;          ///< per pixel, in all passes
    double seconds = 0.0;               ///< that its latest step took
    double seconds_since_change = 0.0;  ///< from the latest request to this frame
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
