// SPDX-License-Identifier: Apache-2.0
// A stone lion and a tea set on a table in a large hall.
#include "scenes/generator/furniture.h"
#include "scenes/generator/lion.h"
#include "scenes/generator/pottery.h"
#include "scenes/generator/scenes.h"
#include "scenes/generator/shapes.h"

namespace nearlight::core::scenes {
namespace {

constexpr float kTable = 0.76f;
constexpr float kLionScale = 0.55f;

/// The lion on its plinth of three courses, about 0.6 m high.
Model make_statue(float detail) {
    Model statue;
    statue.add("plinth", box({0.42f, 0.035f, 0.52f}, 0.006f, 3));
    statue.add("plinth", moved(box({0.38f, 0.05f, 0.48f}, 0.016f, 4), {0, 0.033f, 0}));
    statue.add("plinth", moved(box({0.4f, 0.025f, 0.5f}, 0.008f, 3), {0, 0.08f, 0}));
    // Carved bosses around the middle course.
    for (int side = 0; side < 4; ++side) {
        const float half = side % 2 == 0 ? 0.24f : 0.19f, extent = side % 2 == 0 ? 0.15f : 0.2f;
        for (int i = 0; i < 7; ++i) {
            const float x = extent * (static_cast<float>(i) - 3.0f) / 3.0f;
            statue.add("plinth", turned(moved(ellipsoid({0.017f, 0.017f, 0.008f}, 24), {x, 0.058f, half}),
                                        {0, 1, 0}, 90.0f * static_cast<float>(side)));
        }
    }
    Model lion("lion", make_guardian_lion(0.0042f / detail));
    statue.add(lion, translation(0, 0.105, -0.01) * scaling(kLionScale, kLionScale, kLionScale));
    return statue;
}

Model make_tray(Vec3 size) {
    Model tray("lacquer", box({size.x, 0.008f, size.z}, 0.003f));
    for (const float sign : {-1.0f, 1.0f}) {
        tray.add("lacquer", moved(box({size.x + 0.012f, size.y, 0.012f}, 0.004f, 3),
                                  {0, 0.0004f, sign * 0.5f * size.z}));
        tray.add("lacquer", moved(box({0.0115f, size.y - 0.0005f, size.z + 0.011f}, 0.004f, 3),
                                  {sign * 0.5f * size.x, 0.0004f, 0}));
        const float x = sign * 0.5f * size.x;
        const Curve grip = spline(Curve{{x, size.y - 0.006f, -0.05f},
                                        {x + sign * 0.012f, size.y + 0.022f, -0.035f},
                                        {x + sign * 0.014f, size.y + 0.026f, 0},
                                        {x + sign * 0.012f, size.y + 0.022f, 0.035f},
                                        {x, size.y - 0.006f, 0.05f}},
                                  8);
        tray.add("brass", tube(grip, {{0.0045f}, 1.0f, 16}));
    }
    return tray;
}

Model make_mandarin(float degrees) {
    const Profile half{at(0, 0.004f),     at(0.012f, 0.0f),   at(0.032f, 0.012f), at(0.039f, 0.03f),
                       at(0.033f, 0.05f), at(0.014f, 0.058f), at(0, 0.055f)};
    Profile profile = spline(half, 6);
    profile.front().x = profile.back().x = 0.0f;
    Model mandarin("mandarin", roughened(lathe(profile, 64), 0.0009f, 150.0f));
    mandarin.add(
        "leaf",
        moved(lathe(solid(Profile{at(0, 0), at(0.005f, 0), at(0.004f, 0.003f), at(0, 0.005f)}, 0.001f), 16),
              {0, 0.054f, 0}));
    const auto leaf = [](float u, float v) {
        const float half_width = 0.011f * (std::sin(kPi * std::clamp(v, 0.0f, 1.0f)) + 0.05f);
        return Vec3{(2 * u - 1) * half_width, 0.0585f + 0.01f * v - 0.022f * v * v, 0.003f - 0.045f * v};
    };
    mandarin.add("leaf", turned(sheet(leaf, 6, 12, 0.001f), {0, 1, 0}, degrees));
    return mandarin;
}

Model make_tea_spoon() {
    const Curve outside{at(0.004f, 0), at(0.012f, 0.0015f), at(0.0175f, 0.006f)};
    Model spoon;
    spoon.add("brass", scaled(lathe(vessel(outside, 0.0012f), 48), {1, 1, 1.4f}));
    spoon.add(
        "brass",
        tube(spline(Curve{{0, 0.006f, 0.0235f}, {0, 0.012f, 0.045f}, {0, 0.004f, 0.1f}, {0, 0.003f, 0.13f}},
                    8),
             {{0.0024f, 0.002f, 0.0034f}, 0.6f, 16}));
    return spoon;
}

Model make_tea_tray() {
    const float inside = 0.008f;
    Model set = make_tray({0.52f, 0.024f, 0.36f});
    set.place(make_teapot("celadon", "celadon_dark"), {-0.07f, inside, -0.045f}, -28);
    set.place(make_cup_and_saucer("porcelain"), {0.16f, inside, 0.085f}, -40);
    set.place(make_cup_and_saucer("porcelain"), {-0.02f, inside, 0.095f}, 200);
    set.place(make_sugar_bowl("celadon", "celadon_dark"), {0.165f, inside, -0.095f}, 35);
    return set;
}

/// A cloth over the table's middle that hangs down in front and behind.
Mesh make_runner(float width, float table_depth) {
    const float half = 0.5f * table_depth + 0.004f, hang = 0.24f, radius = 0.014f;
    const auto surface = [=](float u, float v) {
        const float flat = half - radius, arc = 0.5f * kPi * radius, total = flat + arc + hang;
        const float s = (v - 0.5f) * 2.0f * total, along = std::abs(s), sign = s < 0 ? -1.0f : 1.0f;
        Vec3 p{(u - 0.5f) * width, 0.0022f, sign * std::min(along, flat)};
        if (along > flat) {
            const float angle = std::min((along - flat) / radius, 0.5f * kPi);
            p.z += sign * radius * std::sin(angle);
            p.y -= radius * (1.0f - std::cos(angle));
        }
        if (along > flat + arc) {
            const float down = along - flat - arc;
            p.y -= down;
            p.z += sign * 0.03f * down * (1.0f + std::sin(u * 19.0f));
        }
        return p;
    };
    return sheet(surface, 60, 160, 0.002f);
}

/// A chest with a lid, iron straps and a round lock plate.
Model make_chest(Vec3 size) {
    Model chest("chest", box({size.x, 0.74f * size.y, size.z}, 0.012f));
    chest.add("chest",
              moved(box({size.x + 0.05f, 0.27f * size.y, size.z + 0.05f}, 0.05f, 4), {0, 0.73f * size.y, 0}));
    for (const float place : {-0.36f, 0.0f, 0.36f}) {
        chest.add("brass",
                  moved(box({0.05f, 0.97f * size.y, size.z + 0.062f}, 0.006f), {place * size.x, 0.035f, 0}));
    }
    chest.add("brass", moved(turned(cylinder(0.09f, 0.03f, 0.006f), {1, 0, 0}, 90),
                             {0, 0.66f * size.y, 0.5f * size.z + 0.01f}));
    return chest;
}

/// A cloth on a rod, with a border and an ornament of golden rings.
Model make_hanging(float width, float height) {
    Model hanging("hanging", moved(box({width, height, 0.05f}, 0.015f), {0, 0, 0}));
    hanging.add("brass",
                transformed(cylinder(0.035f, width + 0.3f),
                            translation(-0.5 * width - 0.15, height - 0.02, 0) * rotation(0, 0, 1, -90)));
    for (const float sign : {-1.0f, 1.0f}) {
        hanging.add("brass", moved(box({0.05f, height - 0.25f, 0.064f}, 0.006f),
                                   {sign * (0.5f * width - 0.12f), 0.1f, 0}));
    }
    for (const float radius : {0.2f, 0.36f, 0.52f}) {
        for (const float y : {0.22f, 0.6f}) {
            hanging.add("brass",
                        moved(turned(torus(radius, 0.028f, 64, 10), {1, 0, 0}, 90), {0, y * height, 0.026f}));
        }
    }
    return hanging;
}

void add_hall(Model& scene) {
    const Vec3 room{16.0f, 6.5f, 14.0f};
    scene.place(make_room(room), {1.0f, 0, 1.5f});
    const Mesh column = make_column(0.36f, room.y);
    for (const float x : {-4.6f, -1.7f, 1.7f, 4.8f}) {
        scene.add("column", moved(column, {x, 0, -4.0f}));
        scene.add("column", moved(column, {x, 0, 6.6f}));
    }
    for (const float x : {-3.15f, 0.0f, 3.25f}) {
        scene.place(make_hanging(1.7f, 3.6f), {x, 1.25f, -5.4f});
        scene.place(make_chest({1.5f, 0.8f, 0.6f}), {x, 0, -4.9f});
    }
    for (const float z : {-1.5f, 2.5f, 5.0f}) {
        scene.add("chest", moved(box({0.9f, 1.6f, 1.4f}, 0.03f), {-6.4f, 0, z}));
        scene.place(make_crock(1.1f, "celadon", "celadon_dark", true), {7.6f, 0, z});
    }
}

}  // namespace

SceneFiles make_stone_and_tea(float detail) {
    SceneFiles scene;
    Model& model = scene.model;
    add_hall(model);
    model.add("table", make_table({1.7f, kTable, 0.95f}));
    model.add("runner", moved(make_runner(0.62f, 0.95f), {0.29f, kTable, 0}));
    const auto put = [&](const Model& thing, float x, float z, float degrees, float lift = 0.0f) {
        model.place(thing, {x, kTable + lift, z}, degrees);
    };
    put(make_statue(detail), -0.34f, -0.1f, 24);
    const float cloth = 0.0034f;
    put(make_tea_tray(), 0.28f, 0.05f, -6, cloth);
    put(make_tea_caddy("caddy", "brass"), 0.03f, -0.29f, 0, cloth);
    put(make_mandarin(30), -0.06f, 0.3f, 0);
    put(make_mandarin(160), -0.15f, 0.335f, 40);
    put(make_mandarin(250), -0.1f, 0.255f - 0.035f, 10);
    put(make_tea_spoon(), 0.36f, 0.3f, 74, cloth);
    scene.bitmaps["table"] = make_wood_grain({0.55f, 0.36f, 0.22f}, {0.36f, 0.21f, 0.12f}, 12);
    return scene;
}

}  // namespace nearlight::core::scenes
