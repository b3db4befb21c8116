// SPDX-License-Identifier: Apache-2.0
// Camera and light that replace what a file says, whatever its format. +Y is up.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "host/scene/note_sink.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// Where the sun stands.
struct SunPosition {
    double azimuth = 0;    ///< degrees from +Z towards +X
    double elevation = 0;  ///< degrees above the horizon, 0 to 90
};

struct SceneOverrides {
    std::optional<std::array<double, 3>> origin{};  ///< of the camera; empty: its own
    /// What the camera looks at; empty: the middle of the scene if there is an origin, otherwise as it
    /// stands.
    std::optional<std::array<double, 3>> target{};
    /// What points upwards in the picture; empty: the axis of the world that does so as the camera stands.
    std::optional<std::array<double, 3>> up{};
    /// Horizontal field of view of the picture, above 0 and below 180, with which an orthographic camera
    /// becomes a perspective one.
    std::optional<double> fov_degrees{};
    /// An image file (latitude-longitude), `sky` (a clear sky), or a colour: R,G,B or one number as a
    /// radiance, or #rrggbb. Empty: the scene's own environment.
    std::string environment{};
    /// Degrees about +Y by which the environment turns, and a factor of its light, whether it is the scene's
    /// own or not. They count for its sun as well, but not for a `sun` that is added to another environment
    /// than `sky`.
    double environment_rotation = 0;
    double environment_scale = 1;
    std::optional<SunPosition> sun{};  ///< a sun, whose place the sky follows
    double light_scale = 1;            ///< of all light

    /// Whether the overrides bring light of their own.
    [[nodiscard]] bool bring_light() const { return !environment.empty() || sun.has_value(); }
};

/// Where the camera of the scene stands, or where the overrides place it.
Vec3 eye_of(const Scene& scene, const SceneOverrides& overrides);

/// A camera of the file with its overrides. With an origin but no target, it looks at the middle of `scene`.
SceneCamera overridden(SceneCamera camera, const Scene& scene, const SceneOverrides& overrides);

/// Applies the overrides to a complete scene. Throws Error: ErrorKind::invalid_argument for a number that is
/// not finite or out of range, or a camera that posed() refuses; ErrorKind::file for an environment that
/// cannot be read.
void apply_overrides(Scene& scene, const SceneOverrides& overrides, NoteSink& notes);

}  // namespace nearlight::core
