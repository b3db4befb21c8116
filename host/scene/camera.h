// SPDX-License-Identifier: Apache-2.0
// Converts the scene's camera to the struct that ray generation uses.
#pragma once

#include <array>
#include <optional>

#include "host/scene/scene.h"
#include "nearlight/settings.h"

namespace nearlight::core {

/// The part of the plane at distance 1 (or of an orthographic film) that a picture shows, in the camera's
/// local units: x to the right and y downwards from the axis.
struct PictureWindow {
    double left = 0.0;
    double top = 0.0;
    double pixel = 0.0;  ///< side of a pixel, which is square
};

/// The window of a picture of width × height pixels. It has the horizontal extent and the middle that
/// `camera` says, for any aspect.
PictureWindow picture_window(const SceneCamera& camera, int width, int height);

/// The camera for a picture of width × height pixels. The horizontal field of view is that of `camera` for
/// any aspect, and pixels are square. Throws Error(ErrorKind::invalid_argument) for a picture without pixels
/// or a field of view that is not between 0 and 180 degrees.
Camera make_camera(const SceneCamera& camera, int width, int height);

/// The camera as a perspective one whose film has this horizontal field of view; the scale of an orthographic
/// one is lost. Throws Error(ErrorKind::invalid_argument) if the field is not between 0 and 180 degrees.
SceneCamera with_field_of_view(SceneCamera camera, double fov_x_degrees);

/// Where a camera stands and looks, to more digits than a CameraPose has: far from the origin, directions
/// between points need them.
struct ExactPose {
    std::array<double, 3> origin{};  ///< m
    std::array<double, 3> target{};  ///< a point in the middle of the film, m
    std::array<double, 3> up{};
};

/// Where the camera stands and looks: a target at the distance 1.
ExactPose exact_pose_of(const SceneCamera& camera);
/// Where the camera stands and looks: a target at the distance 1, and a field of view if it is perspective.
CameraPose pose_of(const SceneCamera& camera);
/// Moves the camera and keeps the rest: film, lens and clips, whether it mirrors, and the scale of an
/// orthographic one. Throws Error(ErrorKind::invalid_argument) if a number is not finite, if the target lies
/// at the origin or in the direction of `up` from there, or if the field of view is not between 0 and 180
/// degrees.
SceneCamera posed(SceneCamera camera, const CameraPose& pose);
SceneCamera posed(SceneCamera camera, const ExactPose& pose);

/// The ray through the centre of a pixel and of the lens, from the near clip to the far one; the direction
/// has unit length.
RayQuery pixel_ray(const Camera& camera, uint x, uint y);

/// A place in the plane of the film, which may lie beyond the borders of the picture.
struct FilmPosition {
    double x = 0.0;         ///< pixels from the left border of the picture
    double y = 0.0;         ///< pixels from its top border
    double distance = 0.0;  ///< from where the ray starts to the point, m
};
/// Where the camera sees `point` through the middle of its lens. Empty for points that are not in front of
/// the camera.
std::optional<FilmPosition> film_position(const SceneCamera& camera, Vec3 point);

}  // namespace nearlight::core
