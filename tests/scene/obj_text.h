// SPDX-License-Identifier: Apache-2.0
// Scenes of OBJ files for tests.
#pragma once

#include "tests/scene/scene_files.h"

namespace nearlight::core::test {

inline Scene load_obj(const SceneFiles& files, const std::string& text) {
    return load_scene(files.write("m.obj", text));
}

}  // namespace nearlight::core::test
