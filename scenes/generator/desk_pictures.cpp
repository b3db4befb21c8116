// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/desk_pictures.h"

#include "host/base/random.h"

namespace nearlight::core::scenes {

Bitmap make_screen_picture() {
    Bitmap screen(512, 288, {0.10f, 0.30f, 0.45f});
    for (int y = 0; y < 288; ++y) {
        screen.fill(0, y, 512, 1,
                    Vec3{0.12f, 0.35f, 0.55f} + Vec3{0.35f, 0.2f, 0.1f} * (static_cast<float>(y) / 288.0f));
    }
    screen.fill(40, 30, 300, 220, {0.93f, 0.93f, 0.91f});
    screen.fill(40, 30, 300, 18, {0.25f, 0.27f, 0.33f});
    const Vec3 inks[] = {
        {0.15f, 0.35f, 0.65f}, {0.65f, 0.2f, 0.2f}, {0.2f, 0.5f, 0.25f}, {0.25f, 0.25f, 0.25f}};
    Pcg32 random(41);
    for (int line = 0; line < 20; ++line) {
        int x = 52 + 14 * static_cast<int>(random.next() % 4);
        for (int word = 0; word < 4; ++word) {
            const int width = 14 + static_cast<int>(random.next() % 46);
            if (x + width < 328) {
                screen.fill(x, 58 + line * 9, width, 4, inks[random.next() % 4]);
            }
            x += width + 6;
        }
    }
    screen.fill(300, 110, 180, 130, {0.16f, 0.17f, 0.2f});
    screen.fill(300, 110, 180, 14, {0.7f, 0.45f, 0.15f});
    for (int bar = 0; bar < 8; ++bar) {
        const int height = 20 + static_cast<int>(random.next() % 80);
        screen.fill(314 + bar * 20, 232 - height, 13, height,
                    {0.3f, 0.75f - 0.05f * static_cast<float>(bar), 0.45f + 0.05f * static_cast<float>(bar)});
    }
    screen.fill(0, 272, 512, 16, {0.13f, 0.14f, 0.18f});
    return screen;
}

Bitmap make_printed_page(std::uint64_t seed, bool with_picture) {
    const Vec3 paper{0.93f, 0.9f, 0.82f}, ink{0.2f, 0.18f, 0.17f};
    Bitmap page(256, 364, paper);
    Pcg32 random(seed);
    for (int line = 0; line < 30; ++line) {
        const int y = 28 + line * 10;
        if (with_picture && line >= 4 && line < 15) {
            continue;
        }
        for (int x = 30; x < 222;) {
            const int word = 8 + static_cast<int>(random.next() % 22);
            page.fill(x, y, std::min(word, 226 - x), line == 0 ? 6 : 4, ink);
            x += word + 5;
            x += line == 0 && x > 120 ? 200 : 0;
        }
    }
    if (with_picture) {
        page.fill(40, 72, 176, 96, {0.45f, 0.6f, 0.7f});
        page.fill(40, 128, 176, 40, {0.35f, 0.5f, 0.25f});
        page.fill(150, 86, 26, 26, {0.9f, 0.7f, 0.2f});
    }
    return page;
}

Bitmap make_painting() {
    Bitmap painting(320, 240, {1, 1, 1});
    for (int x = 0; x < 320; ++x) {
        const float fx = static_cast<float>(x);
        const float far_hill = 120.0f + 22.0f * std::sin(fx * 0.021f + 1.0f),
                    near_hill = 165.0f + 26.0f * std::sin(fx * 0.016f + 3.4f);
        for (int y = 0; y < 240; ++y) {
            const float fy = static_cast<float>(y);
            const float sun = std::hypot(fx - 215.0f, fy - 80.0f);
            Vec3 color = Vec3{0.95f, 0.72f, 0.45f} * (fy / 150.0f) +
                         Vec3{0.35f, 0.5f, 0.72f} * std::max(0.0f, 1.0f - fy / 150.0f);
            color = sun < 24.0f ? Vec3{0.98f, 0.9f, 0.6f} : color;
            color = fy > far_hill ? Vec3{0.42f, 0.42f, 0.55f} : color;
            color = fy > near_hill ? Vec3{0.3f, 0.42f, 0.22f} : color;
            painting.set(x, y, color);
        }
    }
    return painting;
}

}  // namespace nearlight::core::scenes
