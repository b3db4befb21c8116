// SPDX-License-Identifier: Apache-2.0
// Scene files for tests of the whole program.
#pragma once

#include <string>

namespace nearlight::core {

struct SmallView {
    int max_depth;
    float fov_degrees;
    const char* origin;  ///< position of the camera, which looks at the middle of the floor
    int width;
    int height;
};

/// A floor of 2 m × 2 m, 1 m below a point light of 1 W/sr; `more` is added to the scene.
inline std::string lit_floor(const SmallView& view, const std::string& more = {}) {
    const auto entry = [](const char* type, const char* name, auto value) {
        return std::string("<") + type + " name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
    };
    return R"(<scene version="3.0.0">
  <integrator type="path">)" +
           entry("integer", "max_depth", view.max_depth) + R"(</integrator>
  <sensor type="perspective">
    )" + entry("float", "fov", view.fov_degrees) +
           R"(
    <transform name="to_world"><lookat origin=")" +
           view.origin + R"(" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm">)" +
           entry("integer", "width", view.width) + entry("integer", "height", view.height) + R"(</film>
  </sensor>
  <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.25, 0.125"/></bsdf></shape>
  <emitter type="point"><point name="position" x="0" y="0" z="1"/><rgb name="intensity" value="1, 1, 1"/></emitter>
  )" + more +
           "\n</scene>";
}

/// The floor and a wall behind it, 64 × 48 pixels; `more` is added to the scene.
inline std::string floor_and_wall(const std::string& more = {}) {
    return lit_floor({.max_depth = 5, .fov_degrees = 60, .origin = "0, -1, 3", .width = 64, .height = 48},
                     R"(<shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="90"/><translate y="1" z="1"/></transform>
    <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.7, 0.7"/></bsdf></bsdf>
  </shape>
  )" + more);
}

}  // namespace nearlight::core
