// SPDX-License-Identifier: Apache-2.0
// A camera and light for files that have none.
#pragma once

#include "host/scene/note_sink.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// A 640 × 480 camera (45° wide) that frames the bounding box from the front, right and above; y is up.
SceneCamera default_camera(const Aabb& box);

/// If no material emits and there is no other light, adds an environment of radiance 1 and a point light
/// beside the default camera, with a remark.
void add_default_light(Scene& scene, NoteSink& notes);
/// Adds the default camera with a remark, and light as add_default_light() does.
void add_default_view(Scene& scene, NoteSink& notes);

}  // namespace nearlight::core
