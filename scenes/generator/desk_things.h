// SPDX-License-Identifier: Apache-2.0
// The things on the desk. Unless its comment says otherwise, each stands on y = 0 and is centred in x and z.
#pragma once

#include "host/base/random.h"
#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// A lamp from `foot` to a shade whose opening is about `head`, where there is room for a point light.
Model make_desk_lamp(Vec3 foot, Vec3 head);
Model make_monitor();
Model make_keyboard();
Model make_mouse();
/// A pencil that stands upright, its point up.
Model make_pencil(const std::string& paint, float length);
Model make_pencil_cup(Pcg32& random);
Model make_open_book();
Model make_potted_plant(Pcg32& random);
/// Five books with an apple on top.
Model make_book_stack(Pcg32& random);
/// Four sheets of paper, of which the top one is a letter.
Model make_papers(Pcg32& random);
/// A framed painting in the plane z = 0, centred, that faces +z.
Model make_picture(float width, float height);

}  // namespace nearlight::core::scenes
