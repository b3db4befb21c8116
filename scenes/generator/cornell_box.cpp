// SPDX-License-Identifier: Apache-2.0
// The measured Cornell box [Goral et al. 1984; data: Cornell University Program of Computer Graphics,
// https://www.graphics.cornell.edu/online/box/data.html], converted from millimetres to metres.
#include "scenes/generator/scenes.h"

namespace nearlight::core::scenes {
namespace {

using Quad = std::array<Vec3, 4>;

Mesh flat(std::initializer_list<Quad> quads) {
    Mesh mesh;
    for (const Quad& quad : quads) {
        const Vec3 normal = normalize(cross(quad[1] - quad[0], quad[3] - quad[0]));
        uint corner[4];
        for (size_t i = 0; i < 4; ++i) {
            corner[i] = mesh.add_vertex(quad[i] * 0.001f, normal, i == 1 || i == 2 ? 1.0f : 0.0f,
                                        i >= 2 ? 1.0f : 0.0f);
        }
        mesh.add_quad(corner[0], corner[1], corner[2], corner[3]);
    }
    return mesh;
}

/// The light lies in the plane of the ceiling, so the ceiling is cut out around it.
Mesh make_ceiling(const Quad& outer, const Quad& hole) {
    return flat({{outer[0], outer[1], hole[1], hole[0]},
                 {outer[1], outer[2], hole[2], hole[1]},
                 {outer[2], outer[3], hole[3], hole[2]},
                 {outer[3], outer[0], hole[0], hole[3]}});
}

}  // namespace

SceneFiles make_cornell_box() {
    const Quad ceiling{Vec3{556.0f, 548.8f, 0.0f}, Vec3{556.0f, 548.8f, 559.2f}, Vec3{0.0f, 548.8f, 559.2f},
                       Vec3{0.0f, 548.8f, 0.0f}};
    const Quad light{Vec3{343.0f, 548.8f, 227.0f}, Vec3{343.0f, 548.8f, 332.0f}, Vec3{213.0f, 548.8f, 332.0f},
                     Vec3{213.0f, 548.8f, 227.0f}};
    SceneFiles scene;
    scene.model.add("light", flat({light}));
    scene.model.add("ceiling", make_ceiling(ceiling, light));
    scene.model.add("floor",
                    flat({{Vec3{552.8f, 0, 0}, Vec3{0, 0, 0}, Vec3{0, 0, 559.2f}, Vec3{549.6f, 0, 559.2f}}}));
    scene.model.add("back_wall", flat({{Vec3{549.6f, 0, 559.2f}, Vec3{0, 0, 559.2f}, Vec3{0, 548.8f, 559.2f},
                                        Vec3{556.0f, 548.8f, 559.2f}}}));
    scene.model.add("right_wall",
                    flat({{Vec3{0, 0, 559.2f}, Vec3{0, 0, 0}, Vec3{0, 548.8f, 0}, Vec3{0, 548.8f, 559.2f}}}));
    scene.model.add("left_wall", flat({{Vec3{552.8f, 0, 0}, Vec3{549.6f, 0, 559.2f},
                                        Vec3{556.0f, 548.8f, 559.2f}, Vec3{556.0f, 548.8f, 0}}}));
    scene.model.add("short_block",
                    flat({{Vec3{130, 165, 65}, Vec3{82, 165, 225}, Vec3{240, 165, 272}, Vec3{290, 165, 114}},
                          {Vec3{290, 0, 114}, Vec3{290, 165, 114}, Vec3{240, 165, 272}, Vec3{240, 0, 272}},
                          {Vec3{130, 0, 65}, Vec3{130, 165, 65}, Vec3{290, 165, 114}, Vec3{290, 0, 114}},
                          {Vec3{82, 0, 225}, Vec3{82, 165, 225}, Vec3{130, 165, 65}, Vec3{130, 0, 65}},
                          {Vec3{240, 0, 272}, Vec3{240, 165, 272}, Vec3{82, 165, 225}, Vec3{82, 0, 225}}}));
    scene.model.add(
        "tall_block",
        flat({{Vec3{423, 330, 247}, Vec3{265, 330, 296}, Vec3{314, 330, 456}, Vec3{472, 330, 406}},
              {Vec3{423, 0, 247}, Vec3{423, 330, 247}, Vec3{472, 330, 406}, Vec3{472, 0, 406}},
              {Vec3{472, 0, 406}, Vec3{472, 330, 406}, Vec3{314, 330, 456}, Vec3{314, 0, 456}},
              {Vec3{314, 0, 456}, Vec3{314, 330, 456}, Vec3{265, 330, 296}, Vec3{265, 0, 296}},
              {Vec3{265, 0, 296}, Vec3{265, 330, 296}, Vec3{423, 330, 247}, Vec3{423, 0, 247}}}));
    return scene;
}

}  // namespace nearlight::core::scenes
