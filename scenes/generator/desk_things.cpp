// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/desk_things.h"

#include "scenes/generator/furniture.h"
#include "scenes/generator/shapes.h"

namespace nearlight::core::scenes {
namespace {

Mesh make_leaf(float leaf_length, float width, float droop) {
    const auto surface = [=](float u, float v) {
        const float t = std::clamp(v, 0.0f, 1.0f);
        const float half = 0.5f * width * (std::pow(std::sin(3.1f * std::pow(t, 0.8f)), 0.8f) + 0.04f);
        const float across = 2.0f * u - 1.0f;
        const float bend = droop * v;
        return Vec3{across * half,
                    leaf_length * (std::sin(bend + 1e-3f) - 0.6f * v * bend) / (droop + 1e-3f) +
                        0.25f * half * across * across,
                    -leaf_length * (1.0f - std::cos(bend)) / (droop + 1e-3f) - 0.35f * leaf_length * v};
    };
    return sheet(surface, 10, 20, 0.0012f);
}

Model make_apple() {
    const Profile half{at(0, 0.009f),      at(0.01f, 0.002f),  at(0.02f, 0.001f),
                       at(0.033f, 0.015f), at(0.04f, 0.042f),  at(0.032f, 0.067f),
                       at(0.018f, 0.073f), at(0.006f, 0.066f), at(0, 0.062f)};
    Profile profile = spline(half, 8);
    profile.front().x = profile.back().x = 0.0f;
    Model apple("apple", lathe(profile, 64));
    apple.add("stem", tube(spline(Curve{{0, 0.06f, 0}, {0.001f, 0.072f, 0}, {0.006f, 0.086f, 0.002f}}, 6),
                           {{0.0014f, 0.0018f}, 1.0f, 10}));
    apple.add("leaf_dark",
              transformed(make_leaf(0.035f, 0.016f, 0.8f),
                          translation(0.004, 0.08, 0) * rotation(0, 1, 0, -60) * rotation(1, 0, 0, 20)));
    return apple;
}

}  // namespace

Model make_desk_lamp(Vec3 foot, Vec3 head) {
    const Profile base{at(0, 0),          at(0.085f, 0),     at(0.085f, 0.012f),
                       at(0.03f, 0.026f), at(0.014f, 0.05f), at(0, 0.05f)};
    Model lamp("lamp_enamel", moved(lathe(rounded(base, 0.008f), 64), foot));
    const Vec3 shoulder = foot + Vec3{0, 0.045f, 0}, elbow = foot + Vec3{-0.1f, 0.36f, -0.02f};
    const Vec3 wrist = head + Vec3{-0.05f, 0.095f, -0.01f};
    for (const float z : {-0.012f, 0.012f}) {
        const Vec3 offset{0, 0, z};
        lamp.add("brass", tube(Curve{shoulder + offset, elbow + offset}, {{0.006f}, 1.0f, 16}));
        lamp.add("brass", tube(Curve{elbow + offset, wrist + offset}, {{0.006f}, 1.0f, 16}));
    }
    for (const Vec3 joint : {shoulder, elbow, wrist}) {
        lamp.add("lamp_enamel",
                 moved(turned(moved(cylinder(0.017f, 0.044f, 0.003f, 32), {0, -0.022f, 0}), {1, 0, 0}, 90),
                       joint));
    }
    const Curve outside{at(0.026f, 0), at(0.03f, 0.03f), at(0.045f, 0.06f), at(0.085f, 0.11f),
                        at(0.105f, 0.15f)};
    lamp.add("lamp_enamel", transformed(lathe(vessel(outside, 0.003f), 96),
                                        translation(wrist.x, wrist.y, wrist.z) * rotation(0, 0, 1, 18) *
                                            rotation(1, 0, 0, 170) * translation(0, 0.005, 0)));
    return lamp;
}

Model make_monitor() {
    Model monitor("monitor_case", moved(box({0.6f, 0.36f, 0.028f}, 0.008f, 3), {0, 0.12f, 0}));
    const auto screen = [](float u, float v) {
        return Vec3{(u - 0.5f) * 0.572f, (0.5f - v) * 0.322f + 0.305f, 0.0143f};
    };
    monitor.add("screen", sheet(screen, 8, 8, 0.001f));
    monitor.add("monitor_case", moved(box({0.07f, 0.2f, 0.02f}, 0.006f), {0, 0.01f, -0.02f}));
    monitor.add("monitor_case", box({0.24f, 0.014f, 0.18f}, 0.006f, 3));
    return monitor;
}

Model make_keyboard() {
    constexpr float kPitch = 0.0205f;
    Model keyboard("keyboard_case", box({0.35f, 0.014f, 0.138f}, 0.006f, 3));
    const auto add_key = [&](float column, float row, float units, const std::string& part) {
        const float width = units * kPitch - 0.003f;
        const Mesh key = box({width, 0.011f, kPitch - 0.003f}, 0.0028f, 2);
        keyboard.add(
            part, moved(key, {-0.164f + (column + 0.5f * units) * kPitch, 0.0118f, -0.051f + row * kPitch}));
    };
    for (int row = 0; row < 5; ++row) {
        const float first = row == 0 ? 1.0f : 1.25f + 0.25f * static_cast<float>(row);
        const float last = row == 0 ? 14.0f : 16.0f - (row == 4 ? 0.0f : 1.75f);
        add_key(0, static_cast<float>(row), first, row == 0 ? "key_accent" : "key_dark");
        if (row == 4) {
            break;
        }
        float column = first;
        for (; column + 1.0f <= last; column += 1.0f) {
            add_key(column, static_cast<float>(row), 1.0f, "key_light");
        }
        add_key(column, static_cast<float>(row), 16.0f - column, row == 2 ? "key_accent" : "key_dark");
    }
    float column = 2.25f;
    for (const float units : {1.25f, 6.5f, 1.25f, 1.25f, 1.25f, 1.25f, 1.0f}) {
        add_key(column, 4.0f, units, units > 2.0f ? "key_light" : "key_dark");
        column += units;
    }
    for (int i = 0; i < 16; ++i) {
        add_key(static_cast<float>(i), 5.0f, 1.0f, i < 3 || i > 12 ? "key_dark" : "key_light");
    }
    return keyboard;
}

Model make_mouse() {
    const Mesh body = ellipsoid({0.031f, 0.026f, 0.052f}, 64);
    Model mouse("key_light", moved(box({0.05f, 0.01f, 0.09f}, 0.005f), {0, 0, 0}));
    mouse.add("key_light", moved(body, {0, 0.011f, 0}));
    mouse.add("key_dark",
              moved(turned(moved(cylinder(0.009f, 0.007f, 0.002f, 32), {0, -0.0035f, 0}), {0, 0, 1}, 90),
                    {0, 0.032f, -0.024f}));
    return mouse;
}

Model make_pencil(const std::string& paint, float length) {
    const auto stick = [&](float from, float to, float radius_from, float radius_to, int sides) {
        return tube(Curve{{0, from, 0}, {0, 0.5f * (from + to), 0}, {0, to, 0}},
                    {{radius_from, radius_to}, 1.0f, sides, sides == 6});
    };
    Model pencil(paint, stick(0.002f, length, 0.0036f, 0.0036f, 6));
    pencil.add("pencil_wood", stick(length, length + 0.014f, 0.0037f, 0.0013f, 16));
    pencil.add("pencil_lead", stick(length + 0.013f, length + 0.019f, 0.0012f, 0.0004f, 12));
    return pencil;
}

Model make_pencil_cup(Pcg32& random) {
    const Curve outside{at(0.036f, 0), at(0.0375f, 0.004f), at(0.0375f, 0.05f), at(0.0385f, 0.1f)};
    Model cup("pencil_cup", lathe(vessel(outside, 0.003f), 80));
    for (const float y : {0.02f, 0.08f}) {
        cup.add("brass", moved(torus(0.0382f, 0.0018f), {0, y, 0}));
    }
    const char* paints[] = {"book_red",   "book_ochre", "book_blue", "book_green",
                            "key_accent", "book_plum",  "book_ochre"};
    int index = 0;
    for (const char* paint : paints) {
        const double around = 360.0 * index++ / std::size(paints) + between(random, -10, 10);
        const Mat4 lean = rotation(0, 1, 0, around) * translation(0.008, 0.0075, 0) *
                          rotation(0, 0, 1, -between(random, 9, 13));
        cup.add(make_pencil(paint, between(random, 0.13f, 0.155f)), lean);
    }
    return cup;
}

/// An open book with a printed page on each side of the gutter.
Model make_open_book() {
    Model book;
    for (const float side : {-1.0f, 1.0f}) {
        const auto page = [side](float u, float v) {
            const float across = side > 0 ? u : 1.0f - u;  // 0 at the gutter, 1 at the outer edge
            const float rise =
                0.018f * std::pow(std::sin(3.1f * std::clamp(across * 0.93f + 0.07f, 0.0f, 1.0f)), 0.6f) *
                    (1.0f - 0.55f * across) +
                0.006f;
            return Vec3{side * (0.002f + 0.155f * across), rise, (v - 0.5f) * 0.225f};
        };
        book.add(side > 0 ? "page_right" : "page_left", sheet(page, 48, 16, 0.0012f));
        const auto block = [&](float u, float v) {
            const Vec3 p = page(u, v);
            return Vec3{p.x * 0.993f, 0.5f * (p.y + 0.0035f), p.z * 0.99f};
        };
        book.add("pages", sheet(block, 32, 4, 0.0045f));
        book.add("book_blue", moved(box({0.164f, 0.003f, 0.236f}, 0.0012f), {side * 0.0835f, 0, 0}));
    }
    book.add("book_blue", box({0.012f, 0.0026f, 0.2355f}, 0.001f));
    book.add("book_red", moved(box({0.006f, 0.0012f, 0.12f}, 0.0005f, 1), {0.0f, 0.0075f, 0.13f}));
    return book;
}

Model make_potted_plant(Pcg32& random) {
    const Curve outside{at(0.05f, 0),       at(0.054f, 0.004f), at(0.066f, 0.07f),
                        at(0.072f, 0.098f), at(0.078f, 0.1f),   at(0.079f, 0.12f)};
    Model plant("terracotta", lathe(vessel(outside, 0.006f), 80));
    plant.add("soil", roughened(moved(lathe(solid(Profile{at(0, 0), at(0.068f, 0), at(0.069f, 0.012f),
                                                          at(0.04f, 0.018f), at(0.02f, 0.019f), at(0, 0.02f)},
                                                  0.004f),
                                            64),
                                      {0, 0.09f, 0}),
                                0.003f, 120.0f));
    for (int i = 0; i < 26; ++i) {
        const float t = static_cast<float>(i) / 26.0f;
        const float height = 0.05f + 0.17f * t, degrees = 137.5f * static_cast<float>(i);
        const float reach = 0.055f * (1.1f - t) + between(random, 0.0f, 0.015f);
        const Vec3 tip{0, 0.105f + height, -reach};
        const Mat4 around = rotation(0, 1, 0, degrees);
        const Curve stem =
            spline(Curve{{0, 0.105f, -0.004f}, {0, 0.105f + 0.55f * height, -0.3f * reach}, tip}, 6);
        plant.add("stem", transformed(tube(stem, {{0.0022f, 0.0016f}, 1.0f, 8}), around));
        plant.add(i % 3 == 0 ? "leaf_light" : "leaf_dark",
                  transformed(make_leaf(between(random, 0.085f, 0.12f), between(random, 0.042f, 0.056f),
                                        between(random, 0.7f, 1.3f)),
                              around * translation(tip.x, tip.y, tip.z) *
                                  rotation(1, 0, 0, between(random, -30, 5) + 45.0f * t)));
    }
    return plant;
}

Model make_book_stack(Pcg32& random) {
    const Vec3 sizes[] = {{0.19f, 0.038f, 0.26f},
                          {0.175f, 0.03f, 0.245f},
                          {0.165f, 0.044f, 0.23f},
                          {0.15f, 0.022f, 0.215f},
                          {0.135f, 0.028f, 0.19f}};
    const char* covers[] = {"book_blue", "book_ochre", "book_red", "book_green", "book_plum"};
    Model stack;
    float y = 0.0005f;
    for (size_t i = 0; i < std::size(sizes); ++i) {
        stack.place(make_book(sizes[i], covers[i], BookFinish::gilded),
                    {between(random, -0.006f, 0.006f), y, between(random, -0.006f, 0.006f)},
                    between(random, -9, 9));
        y += sizes[i].y + 0.001f;
    }
    stack.place(make_apple(), {0.01f, y - 0.0012f, 0.01f}, 40);
    return stack;
}

Model make_papers(Pcg32& random) {
    Model papers;
    for (int i = 0; i < 4; ++i) {
        const float phase = between(random, 0, 6);
        const auto surface = [&](float u, float v) {
            const float curl = 0.012f * std::pow(std::max(0.0f, u + v - 1.25f) / 0.75f, 2.0f) +
                               0.0004f * std::sin(5.0f * u + phase);
            return Vec3{(u - 0.5f) * 0.21f, 0.0012f + 0.0012f * static_cast<float>(i) + curl,
                        (v - 0.5f) * 0.297f};
        };
        papers.place(Model(i == 3 ? "letter" : "paper", sheet(surface, 20, 28, 0.0003f)),
                     {between(random, -0.02f, 0.02f), 0, between(random, -0.02f, 0.02f)},
                     between(random, -14, 14));
    }
    return papers;
}

Model make_picture(float width, float height) {
    Model picture;
    const float bar = 0.035f;
    for (const float sign : {-1.0f, 1.0f}) {
        picture.add("drawer_wood", moved(box({width + 2 * bar, bar, 0.03f}, 0.006f, 3),
                                         {0, sign * 0.5f * (height + bar) - 0.5f * bar, 0}));
        picture.add("drawer_wood", moved(box({bar, height + 0.01f, 0.029f}, 0.006f, 3),
                                         {sign * 0.5f * (width + bar), -0.5f * height - 0.005f, 0}));
    }
    picture.add("painting",
                sheet(
                    [=](float u, float v) {
                        return Vec3{(u - 0.5f) * (width + 0.02f), (0.5f - v) * (height + 0.02f), 0.0f};
                    },
                    4, 4, 0.008f));
    return picture;
}

}  // namespace nearlight::core::scenes
