// SPDX-License-Identifier: Apache-2.0
#include "scenes/generator/furniture.h"

#include "scenes/generator/noise.h"
#include "scenes/generator/shapes.h"

namespace nearlight::core::scenes {

float between(Pcg32& random, float low, float high) {
    return low + (high - low) * random.uniform();
}

Model make_room(Vec3 size) {
    constexpr float kThickness = 0.2f;
    const auto slab = [](Vec3 extent, Vec3 center) {
        return moved(box(extent, 0.001f, 1), center - Vec3{0, 0.5f * extent.y, 0});
    };
    const float x = 0.5f * (size.x + kThickness), z = 0.5f * (size.z + kThickness), y = 0.5f * size.y;
    const Vec3 side{kThickness, size.y + 0.1f, size.z + 0.1f}, end{size.x + 0.2f, size.y + 0.15f, kThickness};
    Model room;
    room.add("floor", slab({size.x + 0.3f, kThickness, size.z + 0.3f}, {0, -0.5f * kThickness, 0}));
    room.add("ceiling",
             slab({size.x + 0.35f, kThickness, size.z + 0.35f}, {0, size.y + 0.5f * kThickness, 0}));
    room.add("wall_left", slab(side, {-x, y, 0}));
    room.add("wall_right", slab(side, {x, y, 0}));
    room.add("wall_back", slab(end, {0, y, -z}));
    room.add("wall_front", slab(end, {0, y, z}));
    const float height = 0.12f, depth = 0.018f;
    for (const float sign : {-1.0f, 1.0f}) {
        room.add("skirting", moved(box({depth, height, size.z + 0.05f}, 0.004f),
                                   {sign * (0.5f * size.x - 0.4f * depth), -0.002f, 0}));
        room.add("skirting", moved(box({size.x + 0.04f, height - 0.001f, depth}, 0.004f),
                                   {0, -0.002f, sign * (0.5f * size.z - 0.4f * depth)}));
    }
    return room;
}

Mesh make_column(float radius, float height) {
    const float r = radius;
    const Profile corners{at(0, 0),
                          at(1.45f * r, 0),
                          at(1.45f * r, 0.35f * r),
                          at(1.3f * r, 0.38f * r),
                          at(1.32f * r, 0.6f * r),
                          at(1.08f * r, 0.7f * r),
                          at(r, 0.85f * r),
                          at(1.03f * r, 0.4f * height),
                          at(0.86f * r, height - 1.1f * r),
                          at(1.0f * r, height - 1.0f * r),
                          at(0.92f * r, height - 0.85f * r),
                          at(1.35f * r, height - 0.4f * r),
                          at(1.45f * r, height - 0.35f * r),
                          at(1.45f * r, height),
                          at(0, height)};
    return lathe(rounded(corners, 0.12f * r), 64);
}

Model make_book(Vec3 size, const std::string& cover, BookFinish finish) {
    constexpr float kBoard = 0.003f, kInset = 0.005f;
    const int segments = finish == BookFinish::gilded ? 3 : 1;
    Model book;
    for (const float y : {0.0f, size.y - kBoard}) {
        book.add(cover, moved(box({size.x, kBoard, size.z}, 0.0012f, segments), {0, y, 0}));
    }
    book.add(cover, moved(box({0.006f, size.y + 0.001f, size.z - 0.0006f}, 0.0028f, segments),
                          {-0.5f * size.x, -0.0005f, 0}));
    const Vec3 block{size.x - kInset, size.y - 2 * kBoard + 0.001f, size.z - 2 * kInset};
    book.add("pages", moved(box(block, 0.001f, 1), {-0.5f * kInset, kBoard - 0.0005f, 0}));
    if (finish == BookFinish::gilded) {
        for (const float place : {-0.34f, -0.28f, 0.3f}) {
            book.add("gold", moved(box({0.006f, 0.8f * size.y, 0.006f}, 0.002f),
                                   {-0.5f * size.x - 0.0007f, 0.1f * size.y, place * size.z}));
        }
    }
    return book;
}

Model make_standing_book(Vec3 size, const std::string& cover) {
    // The book is turned with its spine to the front, then with the height of its pages upwards.
    const Mat4 upright = translation(0, 0.5 * size.z, -0.5 * size.x) * rotation(0, 1, 0, 90) *
                         rotation(1, 0, 0, 90) * translation(0, -0.5 * size.y, 0);
    Model book;
    book.add(make_book(size, cover, BookFinish::plain), upright);
    return book;
}

Model make_book_row(float width, float height, const std::vector<std::string>& covers, Pcg32& random) {
    Model row;
    float x = 0.0f;
    while (true) {
        const Vec3 size{between(random, 0.55f, 0.72f) * height, between(random, 0.018f, 0.05f),
                        between(random, 0.78f, 1.0f) * height};
        if (x + size.y > width) {
            return row;
        }
        const std::string& cover = covers[random.next() % covers.size()];
        row.place(make_standing_book(size, cover),
                  {x + 0.5f * size.y, 0.001f, between(random, -0.006f, 0.006f) + size.x});
        x += size.y + between(random, 0.0012f, 0.003f);
    }
}

Model make_bookcase(Vec3 size, int shelves, const std::string& wood, const std::vector<std::string>& covers,
                    Pcg32& random) {
    constexpr float kBoard = 0.03f;
    Model bookcase;
    for (const float sign : {-1.0f, 1.0f}) {
        bookcase.add(wood, moved(box({kBoard, size.y, size.z}), {sign * 0.5f * (size.x - kBoard), 0, 0}));
    }
    bookcase.add(wood,
                 moved(box({size.x - kBoard, size.y - 0.02f, 0.015f}), {0, 0.01f, -0.5f * size.z + 0.02f}));
    const float spacing = (size.y - 0.1f - kBoard) / static_cast<float>(shelves);
    for (int shelf = 0; shelf <= shelves; ++shelf) {
        const float y = 0.08f + spacing * static_cast<float>(shelf);
        bookcase.add(wood,
                     moved(box({size.x - kBoard, kBoard, size.z - 0.012f}), {0, y - 0.5f * kBoard, 0.002f}));
        if (shelf < shelves) {
            bookcase.place(make_book_row((size.x - 2 * kBoard - 0.01f) * between(random, 0.6f, 1.0f),
                                         0.85f * (spacing - kBoard), covers, random),
                           {-0.5f * size.x + kBoard + 0.004f, y + 0.5f * kBoard, -0.5f * size.z + 0.04f});
        }
    }
    return bookcase;
}

Mesh make_armchair() {
    Mesh chair = moved(box({0.62f, 0.2f, 0.66f}, 0.05f, 4), {0, 0.22f, 0.04f});
    chair.append(moved(box({0.6f, 0.14f, 0.6f}, 0.06f, 4), {0, 0.4f, 0.07f}));
    chair.append(moved(turned(box({0.68f, 0.6f, 0.18f}, 0.08f, 4), {1, 0, 0}, -12), {0, 0.38f, -0.32f}));
    for (const float sign : {-1.0f, 1.0f}) {
        chair.append(moved(box({0.16f, 0.4f, 0.76f}, 0.07f, 4), {sign * 0.38f, 0.2f, 0.0f}));
        for (const float z : {-0.28f, 0.3f}) {
            chair.append(moved(cylinder(0.025f, 0.24f), {sign * 0.36f, 0, z}));
        }
    }
    return chair;
}

Mesh make_table(Vec3 size) {
    constexpr float kTop = 0.05f;
    Mesh table = moved(box({size.x, kTop, size.z}, 0.012f, 4), {0, size.y - kTop, 0});
    table.append(moved(box({size.x - 0.16f, 0.11f, size.z - 0.16f}, 0.004f), {0, size.y - kTop - 0.107f, 0}));
    const float h = size.y - kTop;
    const Profile corners{at(0, 0),
                          at(0.03f, 0),
                          at(0.042f, 0.05f),
                          at(0.026f, 0.1f),
                          at(0.05f, 0.35f * h),
                          at(0.035f, 0.6f * h),
                          at(0.055f, h - 0.16f),
                          at(0.055f, h - 0.002f),
                          at(0, h - 0.002f)};
    const Mesh leg = lathe(rounded(corners, 0.03f), 32);
    for (const float x : {-1.0f, 1.0f}) {
        for (const float z : {-1.0f, 1.0f}) {
            table.append(moved(leg, {x * (0.5f * size.x - 0.13f), 0, z * (0.5f * size.z - 0.13f)}));
        }
    }
    return table;
}

Bitmap make_wood_grain(Vec3 light, Vec3 dark, int rings) {
    constexpr int kWidth = 1024, kHeight = 512;
    Bitmap bitmap(kWidth, kHeight, light);
    const auto to_unit = [](int i, int n) { return static_cast<float>(i) / static_cast<float>(n); };
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            // The noise wraps around because x and y each go round a circle in it.
            const float u = 2.0f * kPi * to_unit(x, kWidth), v = to_unit(y, kHeight);
            const float warp =
                fractal_noise({std::cos(u) * 0.6f, std::sin(u) * 0.6f, 3.0f * v * (1.0f - v)}, 3);
            const float ring =
                0.5f + 0.5f * std::sin(2.0f * kPi * (v * static_cast<float>(rings) + 2.2f * warp));
            const float pores =
                0.5f + 0.5f * value_noise({std::cos(u) * 9.0f, std::sin(u) * 9.0f, 200.0f * v});
            const float t = std::clamp(0.55f * ring * ring + 0.2f * warp + 0.3f * pores, 0.0f, 1.0f);
            bitmap.set(x, y, light * (1.0f - t) + dark * t);
        }
    }
    return bitmap;
}

}  // namespace nearlight::core::scenes
