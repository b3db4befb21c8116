// SPDX-License-Identifier: Apache-2.0
// A study: a desk by the wall with the things used there. The rest of the room is behind the camera.
#include "scenes/generator/desk_pictures.h"
#include "scenes/generator/desk_things.h"
#include "scenes/generator/furniture.h"
#include "scenes/generator/pottery.h"
#include "scenes/generator/scenes.h"
#include "scenes/generator/shapes.h"

namespace nearlight::core::scenes {
namespace {

constexpr float kDeskTop = 0.75f;
constexpr float kWall = -0.45f;  // z of the wall behind the desk; the desk's middle is the origin
/// Position of the point light of scene.xml, in the opening of the shade.
constexpr Vec3 kLampHead{-0.3f, 1.2f, 0.0f};

std::vector<std::string> book_covers() {
    return {"book_red", "book_blue", "book_green", "book_ochre", "book_plum"};
}

Model make_drawers(float width, float height, float depth) {
    Model drawers("desk_wood", box({width, height, depth}, 0.004f));
    constexpr int kCount = 3;
    const float front_height = (height - 0.05f) / kCount;
    for (int i = 0; i < kCount; ++i) {
        const float y = 0.03f + front_height * static_cast<float>(i);
        drawers.add("drawer_wood", moved(box({width - 0.04f, front_height - 0.012f, 0.022f}, 0.005f, 3),
                                         {0, y, 0.5f * depth + 0.007f}));
        const Profile knob{at(0, 0),           at(0.008f, 0),      at(0.007f, 0.012f),
                           at(0.016f, 0.018f), at(0.015f, 0.027f), at(0, 0.03f)};
        drawers.add("brass", moved(turned(lathe(rounded(knob, 0.004f), 40), {1, 0, 0}, 90),
                                   {0, y + 0.5f * front_height - 0.006f, 0.5f * depth + 0.017f}));
    }
    return drawers;
}

Model make_desk_furniture() {
    Model desk("desk_top", moved(box({1.7f, 0.035f, 0.8f}, 0.008f, 3), {0, kDeskTop - 0.035f, 0}));
    for (const float x : {-0.6f, 0.6f}) {
        desk.place(make_drawers(0.44f, kDeskTop - 0.036f, 0.72f), {x, 0, 0});
    }
    desk.add("desk_wood", moved(box({0.8f, 0.5f, 0.02f}), {0, 0.2f, -0.3f}));
    return desk;
}

void add_far_furniture(Model& scene, Pcg32& random) {
    scene.place(make_bookcase({1.6f, 2.3f, 0.34f}, 6, "drawer_wood", book_covers(), random),
                {-2.98f, 0, 1.2f}, 90);
    scene.place(make_bookcase({1.6f, 2.3f, 0.34f}, 6, "drawer_wood", book_covers(), random),
                {-2.98f, 0, 3.1f}, 90);
    scene.place(make_bookcase({2.2f, 1.1f, 0.36f}, 3, "desk_wood", book_covers(), random), {3.4f, 0, -0.25f});
    scene.place(Model("armchair", make_armchair()), {2.7f, 0, 2.9f}, -120);
    scene.place(Model("armchair", make_armchair()), {1.0f, 0, 4.4f}, 170);
    scene.place(Model("desk_wood", make_table({0.7f, 0.5f, 0.7f})), {1.9f, 0, 3.7f}, 20);
    scene.add("door", moved(box({0.95f, 2.1f, 0.06f}, 0.01f), {-1.2f, 0.0f, 5.53f}));
    scene.add("rug", moved(box({3.4f, 0.012f, 2.4f}, 0.005f), {1.4f, 0.0f, 2.9f}));
}

void add_desk_things(Model& scene, Pcg32& random) {
    const auto put = [&](const Model& thing, float x, float z, float degrees = 0.0f) {
        scene.place(thing, {x, kDeskTop, z}, degrees);
    };
    put(make_monitor(), 0.06f, -0.2f, -4);
    put(make_keyboard(), 0.08f, 0.17f, 2);
    put(make_mouse(), 0.35f, 0.18f, -8);
    put(make_open_book(), -0.42f, 0.19f, 14);
    put(make_potted_plant(random), -0.7f, -0.22f);
    put(make_pencil_cup(random), -0.31f, -0.12f);
    put(make_book_stack(random), 0.6f, -0.2f, -20);
    put(make_mug("mug"), 0.46f, 0.04f, -35);
    put(make_papers(random), 0.62f, 0.2f, -12);
    const Mat4 on_paper =
        translation(0.6, kDeskTop + 0.0105, 0.22) * rotation(0, 1, 0, 35) * rotation(0, 0, 1, 90);
    scene.add(make_pencil("book_ochre", 0.15f), on_paper);
    scene.add(make_desk_lamp({-0.5f, kDeskTop, -0.27f}, kLampHead));
}

}  // namespace

SceneFiles make_desk() {
    Pcg32 random(2024);
    SceneFiles scene;
    const Vec3 room{8.0f, 3.0f, 6.0f};
    scene.model.place(make_room(room), {0.8f, 0, kWall + 0.5f * room.z});
    scene.model.add(make_desk_furniture());
    add_desk_things(scene.model, random);
    scene.model.place(make_picture(0.32f, 0.24f), {0.58f, 1.25f, kWall + 0.015f});
    add_far_furniture(scene.model, random);
    scene.bitmaps["desk_top"] = make_wood_grain({0.74f, 0.55f, 0.38f}, {0.6f, 0.41f, 0.26f}, 9);
    scene.bitmaps["screen"] = make_screen_picture();
    scene.bitmaps["page_left"] = make_printed_page(5, true);
    scene.bitmaps["page_right"] = make_printed_page(6, false);
    scene.bitmaps["letter"] = make_printed_page(7, false);
    scene.bitmaps["painting"] = make_painting();
    return scene;
}

}  // namespace nearlight::core::scenes
