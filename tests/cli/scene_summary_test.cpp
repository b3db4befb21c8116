// SPDX-License-Identifier: Apache-2.0
#include "host/cli/scene_summary.h"

#include <gtest/gtest.h>

#include "host/scene/material_model.h"
#include "kernels/shared/film_layers.h"

namespace nearlight::core {
namespace {

Scene one_lamp() {
    Scene scene;
    scene.name = "lamp";
    scene.source = "lamp/scene.xml";
    scene.vertices.resize(4);
    scene.vertices[1].position = {2, 0, 0};
    scene.vertices[2].position = {0, 3, 0};
    scene.vertices[3].position = {0, 0, 100};  // used by no triangle
    scene.materials = {diffuse_material({0, 0, 0}), thin_dielectric_material(1.5),
                       diffuse_material({0, 0, 0})};
    scene.materials[2].emission = parameter_of(1.0f);
    scene.triangles = {{0, 1, 2, 0}, {0, 1, 2, 2}};
    scene.camera.width = 100;
    scene.camera.height = 50;
    scene.camera.to_world = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
    scene.notes.push_back({"lamp/scene.xml", 12, "something odd"});
    return scene;
}

TEST(SceneSummary, JsonTellsWhatIsThere) {
    const nlohmann::ordered_json json = scene_summary_json(one_lamp());
    EXPECT_EQ(json["scene"], "lamp");
    EXPECT_EQ(json["triangles"], 2);
    EXPECT_EQ(json["vertices"], 4);
    EXPECT_EQ(json["materials"].dump(), R"({"diffuse":2})") << "no triangle has the thin glass";
    EXPECT_EQ(json["lights"]["triangles"], 1);
    EXPECT_EQ(json["lights"]["points"], 0);
    EXPECT_TRUE(json["lights"]["environment"].is_null());
    EXPECT_NEAR(json["lights"]["power"], 3.0 * 3.14159265, 1e-4);  // π times 3 m² of lamp
    EXPECT_EQ(json["bounds"]["max"].dump(), "[2.0,3.0,0.0]");
    EXPECT_EQ(json["camera"]["position"].dump(), "[0.0,0.0,5.0]");
    EXPECT_NEAR(json["camera"]["direction"][2], -1.0, 1e-6);
    EXPECT_EQ(json["max_depth"], kUnlimitedPathDepth);
    EXPECT_EQ(json["notes"][0]["line"], 12);
}

TEST(SceneSummary, MemoryOfAllParts) {
    Scene scene = one_lamp();
    scene.images.push_back({"wood", 10, 10, NEARLIGHT_TEXELS_SRGB8, std::vector<std::uint32_t>(100)});
    const nlohmann::ordered_json memory = scene_summary_json(scene)["memory_bytes"];
    EXPECT_EQ(memory["host"]["geometry"], 4 * 32 + 2 * 16);
    EXPECT_EQ(memory["host"]["trees"], 2 * 52 + 64);
    EXPECT_EQ(memory["host"]["textures"], 400);
    EXPECT_EQ(memory["host"]["picture"], 100 * 50 * NEARLIGHT_LAYER_CHANNELS * 4);
    for (const auto& place : memory) {
        std::uint64_t sum = 0;
        for (const auto& [name, bytes] : place.items()) {
            sum += name == "total" ? 0 : bytes.get<std::uint64_t>();
        }
        EXPECT_EQ(place["total"], sum);
    }
}

/// Devices hold a band of the picture, hosts all of it.
TEST(SceneSummary, MemoryOfTallPictures) {
    Scene scene = one_lamp();
    scene.camera.width = 1024;
    scene.camera.height = 2048;
    const nlohmann::ordered_json half = scene_summary_json(scene)["memory_bytes"];
    scene.camera.height *= 2;
    const nlohmann::ordered_json whole = scene_summary_json(scene)["memory_bytes"];
    EXPECT_EQ(whole["device"]["picture"], half["device"]["picture"]);
    EXPECT_EQ(whole["host"]["picture"], 2 * half["host"]["picture"].get<std::uint64_t>());
}

/// Half floats take two words a texel, and what vertices have for textures counts with them.
TEST(SceneSummary, MemoryOfTexturesOfAllKinds) {
    Scene scene = one_lamp();
    scene.images.push_back({"wood", 10, 10, NEARLIGHT_TEXELS_SRGB8, std::vector<std::uint32_t>(100)});
    scene.images.push_back({"glow", 10, 10, NEARLIGHT_TEXELS_HALF, std::vector<std::uint32_t>(200)});
    scene.vertex_colors.resize(4);
    scene.second_uvs.resize(4);
    const nlohmann::ordered_json json = scene_summary_json(scene);
    EXPECT_EQ(json["textures"]["texels"], 200);
    EXPECT_EQ(json["memory_bytes"]["host"]["textures"], 400 + 800 + 4 * 12 + 4 * 8);
    EXPECT_EQ(json["memory_bytes"]["device"]["textures"], 400 + 800 + 4 * 12 + 4 * 8);
}

/// A filter that reaches two pixels beyond its own brings light to 25 pixels in 5 rows. A band has 16 rows of
/// the picture.
TEST(SceneSummary, MemoryOfSplats) {
    Scene scene = one_lamp();
    const std::uint64_t without = scene_summary_json(scene)["memory_bytes"]["device"]["picture"];
    scene.camera.filter = {.kind = FilterKind::gaussian, .radius = 2.0};
    const std::uint64_t with = scene_summary_json(scene)["memory_bytes"]["device"]["picture"];
    EXPECT_EQ(with - without, 100 * 16 * (25 * (48 + 2 * 32) + 5 * 80));
}

TEST(SceneSummary, TextTellsTheSame) {
    const std::string text = scene_summary_text(one_lamp());
    for (const char* part : {"lamp/scene.xml", "2 triangles, 4 vertices", "materials   2 diffuse\n",
                             "(0, 0, 0) to (2, 3, 0)", "100x50", "no environment", "not given"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
    }
}

TEST(SceneSummary, TextTellsWhereTheCameraClips) {
    Scene scene = one_lamp();
    EXPECT_EQ(scene_summary_text(scene).find("clips"), std::string::npos) << "it sees everything";
    scene.camera.near_clip = 0.01;
    EXPECT_NE(scene_summary_text(scene).find(", clips from 0.01 m\n"), std::string::npos)
        << scene_summary_text(scene);
    scene.camera.far_clip = 10000;
    EXPECT_NE(scene_summary_text(scene).find(", clips from 0.01 to 10000 m\n"), std::string::npos)
        << scene_summary_text(scene);
}

TEST(SceneSummary, AnimationsAndWhatTheyMove) {
    Scene scene = one_lamp();
    EXPECT_EQ(scene_summary_json(scene)["animations"].dump(), "[]");
    EXPECT_EQ(scene_summary_text(scene).find("animations"), std::string::npos);
    scene.animations = {{.name = "walk",
                         .span = TimeSpan{0.5, 2},
                         .motions = {{"eye", "rotation"},
                                     {"eye", "translation"},
                                     {"a", "weights"},
                                     {"b", "scale"},
                                     {"c", "scale"},
                                     {"d", "scale"},
                                     {"e", "scale"}}},
                        {.name = "two\nlines"},
                        {.fault = "room.glb: has no key"}};
    const std::string text = scene_summary_text(scene);
    for (const char* part :
         {"animations  1 'walk': 0.5 to 2 s, moves eye (rotation, translation), a (weights), "
          "b (scale), c (scale) and 2 more nodes\n",
          "            2 'two lines': moves nothing\n",
          "            3: cannot be played: room.glb: has no key\n"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
    }
    const nlohmann::ordered_json json = scene_summary_json(scene)["animations"];
    EXPECT_EQ(json[0]["name"], "walk");
    EXPECT_EQ(json[0]["begin_seconds"], 0.5);
    EXPECT_EQ(json[0]["end_seconds"], 2.0);
    EXPECT_EQ(json[0]["moves"].size(), 7);
    EXPECT_EQ(json[0]["moves"][1].dump(), R"({"node":"eye","property":"translation"})");
    EXPECT_TRUE(json[0]["fault"].is_null());
    EXPECT_TRUE(json[1]["end_seconds"].is_null());
    EXPECT_EQ(json[2]["fault"], "room.glb: has no key");
}

TEST(SceneSummary, EmptySceneIsNoProblem) {
    EXPECT_TRUE(scene_summary_json(Scene{})["bounds"].is_null());
    EXPECT_NE(scene_summary_text(Scene{}).find("empty"), std::string::npos);
}

}  // namespace
}  // namespace nearlight::core
