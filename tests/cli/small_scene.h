// SPDX-License-Identifier: Apache-2.0
// A scene file for tests of the whole program.
#pragma once

#include <string>

namespace nearlight {

/// A floor and a wall under a point light, 64 × 48 pixels; `more` is put into the scene.
inline std::string floor_and_wall(const std::string& more = {}) {
    return R"(<scene version="3.0.0">
  <integrator type="path"><integer name="max_depth" value="5"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="60"/>
    <transform name="to_world"><lookat origin="0, -1, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="48"/></film>
  </sensor>
  <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.25, 0.125"/></bsdf></shape>
  <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><translate y="1" z="1"/></transform>
    <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.7, 0.7"/></bsdf></bsdf></shape>
  <emitter type="point"><point name="position" x="0" y="0" z="1"/><rgb name="intensity" value="1, 1, 1"/></emitter>
  )" + more +
           "\n</scene>";
}

}  // namespace nearlight
