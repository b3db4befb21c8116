// SPDX-License-Identifier: Apache-2.0
// Scenes of OBJ files for tests.
#pragma once

#include "tests/scene/scene_files.h"

namespace nearlight::core::test {

inline Scene load_obj(const SceneFiles& files, const std::string& text) {
    return load_scene(files.write("m.obj", text));
}

/// The material of the front of a triangle, whose own has two sides.
inline const Material& front_of(const Scene& scene, std::size_t triangle) {
    return scene.materials[scene.materials[scene.triangles.at(triangle).material].child[0]];
}

}  // namespace nearlight::core::test
