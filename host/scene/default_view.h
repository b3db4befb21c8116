// SPDX-License-Identifier: Apache-2.0
// A camera and light for files that have none.
#pragma once

#include "host/scene/note_sink.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// A 640 × 480 camera (45° wide) with the usual filter that frames all triangles from the front, right and
/// above; y is up.
SceneCamera default_camera(const Scene& scene);

/// Adds the default camera, with a remark unless `is_placed`: someone says where it stands.
void add_default_camera(Scene& scene, bool is_placed, NoteSink& notes);

/// Adds a neutral sky with a remark if there is no other light. Surfaces that shine count as lights if
/// `surfaces_are_lamps`.
void add_default_light(Scene& scene, bool surfaces_are_lamps, NoteSink& notes);

}  // namespace nearlight::core
