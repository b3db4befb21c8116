// SPDX-License-Identifier: Apache-2.0
// A gallery of ceramics: a display cabinet full of pots, with crocks under and beside it and more in the hall
// behind.
#include "scenes/generator/furniture.h"
#include "scenes/generator/pottery.h"
#include "scenes/generator/scenes.h"
#include "scenes/generator/shapes.h"

namespace nearlight::core::scenes {
namespace {

constexpr float kWidth = 1.9f, kDepth = 0.46f, kHeight = 2.15f;
constexpr float kLegs = 0.66f;  // height of the open space under the cabinet
constexpr float kBoard = 0.028f;
constexpr float kWall = -0.4f;  // z of the wall behind the cabinet, whose middle is the origin
constexpr int kShelves = 3;
constexpr float kShelfPitch = (kHeight - kLegs - 0.06f) / kShelves;

float shelf_height(int shelf) {
    return kLegs + kBoard + kShelfPitch * static_cast<float>(shelf);
}

Model make_cabinet() {
    Model cabinet;
    const Profile leg{at(0, 0),
                      at(0.028f, 0),
                      at(0.04f, 0.05f),
                      at(0.026f, 0.1f),
                      at(0.044f, 0.3f),
                      at(0.03f, 0.5f),
                      at(0.046f, 0.58f),
                      at(0.046f, kLegs + 0.003f),
                      at(0, kLegs + 0.003f)};
    const Mesh leg_mesh = lathe(rounded(leg, 0.02f), 40);
    for (const float x : {-1.0f, 0.0f, 1.0f}) {
        for (const float z : {-1.0f, 1.0f}) {
            if (x != 0.0f || z < 0.0f) {
                cabinet.add("cabinet_wood",
                            moved(leg_mesh, {x * (0.5f * kWidth - 0.06f), 0, z * (0.5f * kDepth - 0.06f)}));
            }
        }
    }
    cabinet.add("cabinet_back", moved(box({kWidth - 0.03f, kHeight - kLegs - 0.02f, 0.014f}),
                                      {0, kLegs + 0.01f, -0.5f * kDepth + 0.02f}));
    for (const float x : {-1.0f, 1.0f}) {
        cabinet.add("cabinet_wood", moved(box({kBoard, kHeight - kLegs, kDepth}, 0.005f),
                                          {x * 0.5f * (kWidth - kBoard), kLegs, 0}));
    }
    for (int shelf = 0; shelf <= kShelves; ++shelf) {
        cabinet.add("cabinet_wood", moved(box({kWidth - 0.02f, kBoard, kDepth - 0.015f}, 0.006f, 3),
                                          {0, shelf_height(shelf) - kBoard, 0.003f}));
    }
    cabinet.add("cabinet_wood",
                moved(box({kWidth + 0.1f, 0.05f, kDepth + 0.06f}, 0.018f, 4), {0, kHeight - 0.004f, 0}));
    cabinet.add("cabinet_wood",
                moved(box({kWidth + 0.18f, 0.03f, kDepth + 0.11f}, 0.012f, 4), {0, kHeight + 0.04f, 0}));
    cabinet.add("cabinet_wood",
                moved(box({kWidth + 0.05f, 0.045f, kDepth + 0.04f}, 0.015f, 4), {0, kLegs - 0.03f, 0}));
    return cabinet;
}

/// Kinds of pots and their places on one shelf, and the colours they take in turn.
struct ShelfPlan {
    std::vector<Pot> pots;
    int first_color;
};

/// Pairs of glaze and trim.
std::vector<std::array<std::string, 2>> glazes() {
    return {{"glaze_cobalt", "glaze_cream"},     {"glaze_celadon", "glaze_iron"},
            {"glaze_red", "glaze_cream"},        {"glaze_cream", "glaze_cobalt"},
            {"glaze_honey", "glaze_iron"},       {"glaze_turquoise", "glaze_honey"},
            {"glaze_terracotta", "glaze_cream"}, {"glaze_plum", "glaze_celadon"}};
}

void fill_shelf(Model& scene, const ShelfPlan& plan, float y, Pcg32& random) {
    const float inner = kWidth - 2 * kBoard - 0.06f;
    const float pitch = inner / static_cast<float>(plan.pots.size());
    const auto colors = glazes();
    for (size_t i = 0; i < plan.pots.size(); ++i) {
        const auto& [glaze, trim] = colors[(static_cast<size_t>(plan.first_color) + i) % colors.size()];
        const float x =
            -0.5f * inner + pitch * (static_cast<float>(i) + 0.5f) + between(random, -0.01f, 0.01f);
        const bool plate = plan.pots[i] == Pot::plate;
        const bool wide = plate || plan.pots[i] == Pot::bowl;
        const float size = wide ? 1.1f : between(random, 1.24f, 1.4f);
        Model pot;
        pot.add(make_pot(plan.pots[i], glaze, trim), scaling(size, size, size));
        scene.place(pot, {x, y, plate ? -0.1f : between(random, -0.03f, 0.07f)},
                    plate ? 0.0f : between(random, -35, 35));
    }
}

void fill_cabinet(Model& scene, Pcg32& random) {
    const ShelfPlan plans[] = {
        {{Pot::jar, Pot::jug, Pot::round_vase, Pot::bowl, Pot::jar, Pot::jug, Pot::round_vase}, 0},
        {{Pot::amphora, Pot::goblet, Pot::plate, Pot::gourd, Pot::plate, Pot::amphora, Pot::goblet}, 3},
        {{Pot::tall_vase, Pot::gourd, Pot::bottle, Pot::round_vase, Pot::tall_vase, Pot::bottle,
          Pot::amphora},
         5}};
    int shelf = 0;
    for (const ShelfPlan& plan : plans) {
        fill_shelf(scene, plan, shelf_height(shelf++), random);
    }
}

void add_crocks(Model& scene) {
    struct Crock {
        float x, z, height, degrees;
        const char* glaze;
        const char* trim;
        bool lid;
    };
    const Crock crocks[] = {{-0.62f, 0.0f, 0.5f, 20, "crock_brown", "glaze_cream", false},
                            {-0.16f, 0.02f, 0.42f, 75, "glaze_honey", "glaze_iron", true},
                            {0.24f, 0.0f, 0.46f, -30, "glaze_celadon", "crock_brown", true},
                            {0.67f, 0.01f, 0.5f, 50, "crock_brown", "glaze_honey", false},
                            {1.45f, 0.05f, 0.78f, 15, "glaze_cobalt", "glaze_cream", true},
                            {1.28f, 0.56f, 0.42f, 70, "glaze_terracotta", "glaze_cream", false},
                            {-1.44f, 0.05f, 0.72f, -20, "glaze_honey", "glaze_iron", false},
                            {-1.2f, 0.58f, 0.38f, 10, "glaze_cream", "glaze_cobalt", true}};
    for (const Crock& crock : crocks) {
        scene.place(make_crock(crock.height, crock.glaze, crock.trim, crock.lid), {crock.x, 0, crock.z},
                    crock.degrees);
    }
}

void add_hall(Model& scene, Pcg32& random) {
    const Vec3 room{14.0f, 4.2f, 12.0f};
    scene.place(make_room(room), {1.5f, 0, kWall + 0.5f * room.z});
    const Mesh column = make_column(0.22f, room.y);
    for (const float x : {-3.6f, 3.4f, 6.6f}) {
        for (const float z : {0.5f, 4.6f, 8.8f}) {
            scene.add("column", moved(column, {x, 0, z}));
        }
    }
    const std::vector<std::string> covers{"glaze_plum", "glaze_terracotta", "glaze_celadon"};
    for (const float z : {2.6f, 6.2f, 9.4f}) {
        scene.place(make_bookcase({1.9f, 2.2f, 0.42f}, 4, "cabinet_wood", covers, random), {8.27f, 0, z},
                    -90);
    }
    for (const float z : {4.0f, 8.0f}) {
        scene.add("column", moved(box({0.7f, 0.95f, 0.7f}, 0.02f, 3), {-1.4f, 0, z}));
        scene.place(make_crock(0.6f, "glaze_turquoise", "glaze_iron", true), {-1.4f, 0.95f, z});
    }
}

}  // namespace

SceneFiles make_showcase() {
    Pcg32 random(77);
    SceneFiles scene;
    add_hall(scene.model, random);
    scene.model.add(make_cabinet());
    fill_cabinet(scene.model, random);
    add_crocks(scene.model);
    scene.bitmaps["cabinet_wood"] = make_wood_grain({0.5f, 0.32f, 0.2f}, {0.33f, 0.19f, 0.11f}, 12);
    return scene;
}

}  // namespace nearlight::core::scenes
