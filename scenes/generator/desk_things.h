// SPDX-License-Identifier: Apache-2.0
// What stands and lies on the desk; each thing stands on y = 0 and is centred in x and z unless said
// otherwise.
#pragma once

#include "host/base/random.h"
#include "scenes/generator/mesh.h"

namespace nearlight::core::scenes {

/// From the foot to a shade whose opening is about `head`, where a point light may hang free.
Model make_desk_lamp(Vec3 foot, Vec3 head);
Model make_monitor();
Model make_keyboard();
Model make_mouse();
/// Upright, the point up.
Model make_pencil(const std::string& paint, float length);
Model make_pencil_cup(Pcg32& random);
Model make_open_book();
Model make_potted_plant(Pcg32& random);
/// Five books, and an apple on top.
Model make_book_stack(Pcg32& random);
/// Four sheets, the top one a letter.
Model make_papers(Pcg32& random);
/// A framed painting in the plane z = 0, centred; looks along +z.
Model make_picture(float width, float height);

}  // namespace nearlight::core::scenes
