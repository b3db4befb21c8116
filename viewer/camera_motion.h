// SPDX-License-Identifier: Apache-2.0
// How a camera is moved about by hand. All functions are pure: they take a camera and return another one.
#pragma once

#include "nearlight/scene.h"

namespace nearlight::viewer {

/// A camera that stands upright: its picture is never tilted sideways.
struct FreeCamera {
    Vec3 origin{0, 0, 0};         ///< m
    Vec3 forward{0, 0, -1};       ///< unit vector
    Vec3 up{0, 1, 0};             ///< unit vector that is upwards in the scene, not along `forward`
    float pivot_distance = 1.0f;  ///< of the point in the middle of the picture that orbits turn about, m
    double fov_degrees = 0.0;     ///< horizontal; 0: the scene's camera has none, because it is orthographic
};

/// Whether both show the same picture: their pivots may differ.
bool shows_same(const FreeCamera& a, const FreeCamera& b);

/// The scene's own camera. Upwards is the axis of the world that is nearest to the camera's own direction
/// upwards. Orbits turn about what is nearest to the middle of the scene.
FreeCamera free_camera(const CameraPose& pose, const Box& bounds);
/// The camera as a session takes it.
CameraPose pose_of(const FreeCamera& camera);
/// The unit vector to the right in the picture.
Vec3 right_of(const FreeCamera& camera);

/// Turns the camera on the spot, by radians to the right and upwards.
FreeCamera look_about(const FreeCamera& camera, float right, float upwards);
/// Moves the camera about its pivot, by radians to the right and upwards, so that the pivot stays in place.
FreeCamera orbit(const FreeCamera& camera, float right, float upwards);
/// Moves the camera, in metres: to its right, upwards in the scene, and in the direction of its view.
FreeCamera walk(const FreeCamera& camera, float right, float upwards, float ahead);
/// Moves the camera in the plane of its picture, as far as the pivot moves by these parts of the picture's
/// width.
FreeCamera pan(const FreeCamera& camera, float right, float upwards);
/// Brings the pivot nearer by a factor, without reaching it.
FreeCamera approach(const FreeCamera& camera, float factor);
/// Puts the pivot at this distance, which must be positive.
FreeCamera with_pivot(const FreeCamera& camera, float distance);

/// A good speed to walk at, in metres per second: an eighth of the scene's largest side.
float walking_speed(const Box& bounds);

}  // namespace nearlight::viewer
