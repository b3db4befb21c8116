// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_loader.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>

#include "tests/scene/gltf_text.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using testing::Not;
using namespace test;

TEST_F(GltfLoader, ReadsTrianglesAsTextAndAsBinary) {
    for (const bool binary : {false, true}) {
        const Scene scene = load_scene(binary ? files_.write("scene.glb", gltf_.binary())
                                              : files_.write("scene.gltf", gltf_.text()));
        ASSERT_EQ(scene.triangles.size(), 2u);
        expect_close(corner(scene, 0, 1), {1, 0, 0});
        expect_close(corner(scene, 1, 2), {0, 1, 0});
        EXPECT_EQ(scene.vertices[0].v, 0.0f) << "the lower left corner shows the last row of a texture";
        EXPECT_EQ(scene.vertices[2].v, 1.0f);
    }
}

TEST_F(GltfLoader, PlacesNodesBelowOneAnother) {
    gltf_.root["nodes"] = {
        {{"children", {1, 2}}, {"translation", {10, 0, 0}}},
        {{"mesh", 0}, {"scale", {2, 2, 2}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}},
        {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}}};
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), 4u);
    expect_close(corner(scene, 0, 1), {10, 2, 0});
    expect_close(corner(scene, 0, 2), {8, 2, 0});
    expect_close(corner(scene, 2, 1), {11, 0, 5});
}

TEST_F(GltfLoader, StripsFansAndVerticesInTurn) {
    gltf_.primitive().erase("indices");
    const int strip = gltf_.points({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    gltf_.primitive()["attributes"] = {{"POSITION", strip}};
    for (const int mode : {5, 6}) {
        gltf_.primitive()["mode"] = mode;
        const Scene scene = load();
        ASSERT_EQ(scene.triangles.size(), 2u);
        if (mode == 5) {
            const Vec3 normal =
                cross(corner(scene, 1, 1) - corner(scene, 1, 0), corner(scene, 1, 2) - corner(scene, 1, 0));
            expect_close(normal, {0, 0, 1});
        }
    }
    gltf_.primitive()["mode"] = 1;  // lines
    const Scene scene = load();
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_THAT(scene.notes.at(0).text, HasSubstr("lines"));
}

TEST_F(GltfLoader, NumbersOfAllTypes) {
    json& attributes = gltf_.primitive()["attributes"];
    attributes["TEXCOORD_0"] =
        gltf_.accessor(std::vector<std::uint8_t>{0, 255, 255, 255, 255, 0, 0, 51}, 5121, "VEC2", 2, true);
    gltf_.primitive()["indices"] =
        gltf_.accessor(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, 5125, "SCALAR", 1);
    attributes["NORMAL"] = gltf_.accessor(
        std::vector<std::int8_t>{0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, -127}, 5120, "VEC3", 3, true);
    const Scene scene = load();
    EXPECT_FLOAT_EQ(scene.vertices[3].v, 0.8f);
    expect_close(scene.vertices[0].normal, {0, 0, 1});
    expect_close(scene.vertices[3].normal, {0, 0, -1});
}

TEST_F(GltfLoader, SparseAccessors) {
    const int places = gltf_.view(GltfText::raw(std::vector<std::uint16_t>{2}));
    const int values = gltf_.view(GltfText::raw(std::vector<float>{7, 8, 9}));
    json& positions = gltf_.root["accessors"][gltf_.primitive()["attributes"]["POSITION"].get<int>()];
    positions["sparse"] = {{"count", 1},
                           {"indices", {{"bufferView", places}, {"componentType", 5123}, {"byteOffset", 0}}},
                           {"values", {{"bufferView", values}, {"byteOffset", 0}}}};
    const Scene scene = load();
    expect_close(corner(scene, 0, 2), {7, 8, 9});
    expect_close(corner(scene, 0, 1), {1, 0, 0});
}

/// Numbers without a buffer view are 0 except for sparse ones, those of indices too.
TEST_F(GltfLoader, IndicesMayBeSparse) {
    const Scene before = load();
    const int places = gltf_.view(GltfText::raw(std::vector<std::uint16_t>{1, 2, 4, 5}));
    const int values = gltf_.view(GltfText::raw(std::vector<std::uint16_t>{1, 2, 2, 3}));
    json& accessors = gltf_.root["accessors"];
    gltf_.primitive()["indices"] = accessors.size();
    accessors.push_back({{"componentType", 5123},
                         {"type", "SCALAR"},
                         {"count", 6},
                         {"sparse",
                          {{"count", 4},
                           {"indices", {{"bufferView", places}, {"componentType", 5123}, {"byteOffset", 0}}},
                           {"values", {{"bufferView", values}, {"byteOffset", 0}}}}}});
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), before.triangles.size());
    for (std::size_t triangle = 0; triangle < 2; ++triangle) {
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(corner(scene, triangle, i), corner(before, triangle, i));
        }
    }
}

/// Primitives without proper attributes are left out, and the indices of later ones stay with these.
TEST_F(GltfLoader, SparseIndicesStayWithTheirPrimitive) {
    json& accessors = gltf_.root["accessors"];
    json& primitives = gltf_.root["meshes"][0]["primitives"];
    const json whole = primitives[0];
    json sparse = whole;
    sparse["indices"] = accessors.size();
    accessors.push_back({{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3}});
    const json broken[] = {{{"mode", 4}}, {{"attributes", 3}}, {{"attributes", {{"POSITION", "0"}}}}};
    for (const json& first : broken) {
        // Each corner of the triangle without numbers is vertex 0.
        primitives = {first, whole, sparse};
        const Scene last = load();
        ASSERT_EQ(last.triangles.size(), 3u) << first;
        EXPECT_NE(corner(last, 0, 0), corner(last, 0, 1)) << first;
        EXPECT_EQ(corner(last, 2, 0), corner(last, 2, 1)) << first;
        primitives = {first, sparse, whole};
        const Scene middle = load();
        ASSERT_EQ(middle.triangles.size(), 3u) << first;
        EXPECT_EQ(corner(middle, 0, 0), corner(middle, 0, 1)) << first;
        EXPECT_NE(corner(middle, 2, 0), corner(middle, 2, 1)) << first;
    }
}

TEST_F(GltfLoader, LaterVersionsAreRefused) {
    gltf_.root["asset"]["minVersion"] = "2.1";
    EXPECT_THAT(error(), HasSubstr("needs glTF 2.1"));
    gltf_.root["asset"]["minVersion"] = "2.0";
    gltf_.root["asset"]["version"] = "2.7";
    EXPECT_EQ(load().triangles.size(), 2u);
    gltf_.root["asset"] = {{"version", "3.0"}};
    EXPECT_THAT(error(), HasSubstr("needs glTF 3.0"));
}

TEST_F(GltfLoader, ACameraThatTheCallerPlacesIsNotMissing) {
    const Scene scene = load({.overrides = {.origin = std::array<double, 3>{0, 0, 5}}});
    for (const Note& note : scene.notes) {
        EXPECT_THAT(note.text, Not(HasSubstr("no camera")));
    }
}

TEST_F(GltfLoader, OnlyMitsubaScenesHaveParameters) {
    for (const auto& file : {files_.write("scene.gltf", gltf_.text()), files_.write("a.obj", "v 0 0 0\n")}) {
        try {
            load_scene(file, {.parameters = {{"camera", "front"}}});
            ADD_FAILURE() << file;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
            EXPECT_THAT(error.what(), HasSubstr("has no parameter 'camera'; only Mitsuba scenes"));
        }
    }
}

TEST_F(GltfLoader, WithoutCameraAndLightOnesAreMadeUp) {
    const Scene scene = load();
    EXPECT_EQ(scene.notes.size(), 2u);
    EXPECT_TRUE(has_note(scene, "the file has no light; a neutral sky is added"));
    EXPECT_GT(scene.environment.width, 1);
    EXPECT_TRUE(scene.has_open_exposure);
    EXPECT_TRUE(scene.open_veils);
}

TEST_F(GltfLoader, PartsThatGlowAreNoLampsUnlessTheFileHasACamera) {
    gltf_.material()["emissiveFactor"] = {1, 1, 1};
    const Scene scene = load();
    EXPECT_GT(scene.environment.width, 1);
    EXPECT_TRUE(has_note(scene, "no light but surfaces that glow, and no camera; a neutral sky is added"));
    gltf_.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"camera", 0}}};
    EXPECT_EQ(load().environment.width, 0);
}

TEST_F(GltfLoader, WithoutScenesAllNodesAreShown) {
    gltf_.root.erase("scenes");
    gltf_.root.erase("scene");
    gltf_.root["nodes"] = {{{"mesh", 0}}, {{"children", {0}}, {"translation", {5, 0, 0}}}, {{"mesh", 0}}};
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), 4u);
    expect_close(corner(scene, 0, 1), {6, 0, 0});
}

TEST_F(GltfLoader, LongChainsAndDeepExtrasDoNotCrash) {
    json nodes = json::array();
    for (int i = 0; i < 20'000; ++i) {
        nodes.push_back({{"children", {i + 1}}, {"translation", {0.001, 0, 0}}});
    }
    nodes.push_back({{"mesh", 0}});
    gltf_.root["nodes"] = nodes;
    expect_close(corner(load(), 0, 0), {20, 0, 0}, 1e-3f);
    gltf_.root["nodes"] = {{{"mesh", 0}}};
    const std::string text = gltf_.text();
    const std::string deep = std::string(20'000, '[') + std::string(20'000, ']');
    EXPECT_THAT(file_error([&] {
                    load_scene(files_.write("deep.gltf", "{\"extras\":" + deep + "," + text.substr(1)));
                }),
                HasSubstr("nested 20001 levels deep"));
}

/// Extensions of materials and formats of images are noted by the materials that have them.
TEST_F(GltfLoader, ExtensionsThatAreNotReadAreNotedByName) {
    gltf_.root["extensionsUsed"] = {
        "KHR_texture_transform",      "KHR_xmp_json_ld",    "MSFT_lod",
        "KHR_draco_mesh_compression", "KHR_texture_basisu", "KHR_materials_iridescence",
        "KHR_techniques_webgl"};
    gltf_.root["extensions"]["EXT_lights_image_based"]["lights"] = json::array();
    gltf_.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array();
    std::vector<std::string> left_out;
    for (const Note& note : load().notes) {
        if (note.text.find("left out") != std::string::npos) {
            left_out.push_back(note.text);
        }
    }
    EXPECT_THAT(left_out, testing::ElementsAre("KHR_techniques_webgl is left out",
                                               "EXT_lights_image_based is left out"));
    EXPECT_THAT(file_error([&] { load({.parameters = {}, .strict = true}); }),
                HasSubstr("KHR_techniques_webgl is left out"));
}

TEST_F(GltfLoader, StrictRefusesApproximations) {
    gltf_.primitive()["mode"] = 0;
    EXPECT_THAT(file_error([&] { load({.parameters = {}, .strict = true}); }), HasSubstr("points and lines"));
}

TEST_F(GltfLoader, BrokenFilesAreRefused) {
    const auto with = [&](const std::function<void(json&)>& change) {
        const json before = gltf_.root;
        change(gltf_.root);
        const std::string message = error();
        gltf_.root = before;
        return message;
    };
    EXPECT_THAT(with([](json& root) { root["nodes"][0]["mesh"] = 3; }),
                HasSubstr("node 'thing' refers to mesh 3, but there are only 1"));
    EXPECT_THAT(with([](json& root) { root["nodes"][0]["children"] = {0}; }),
                HasSubstr("node 1 is its own ancestor"));
    EXPECT_THAT(with([](json& root) { root["scenes"][0]["nodes"] = {9}; }), HasSubstr("node 9"));
    EXPECT_THAT(with([](json& root) {
                    root["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
                }),
                HasSubstr("two parents"));
    EXPECT_THAT(with([](json& root) {
                    root["accessors"][0].erase("bufferView");
                    root["accessors"][0]["count"] = 1u << 30u;
                }),
                HasSubstr("no buffer view"));
    EXPECT_THAT(
        with([](json& root) { root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 1e300; }),
        HasSubstr("refers to light"));
    EXPECT_THAT(with([](json& root) {
                    root["materials"][0]["emissiveFactor"] = {1e300, 0, 0};
                }),
                HasSubstr("not finite"));
    EXPECT_THAT(with([](json& root) { root["meshes"][0]["primitives"][0]["material"] = 9; }),
                HasSubstr("material 9"));
    EXPECT_THAT(with([](json& root) {
                    root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = 99;
                }),
                HasSubstr("the file refers to accessor 99"));
    EXPECT_THAT(with([](json& root) { root["accessors"][0]["count"] = 5; }), HasSubstr("beyond the end"));
    EXPECT_THAT(with([](json& root) { root["accessors"][0]["count"] = 4000000000000; }),
                HasSubstr("accessor"));
    EXPECT_THAT(with([](json& root) { root["accessors"][0]["byteOffset"] = 4; }),
                HasSubstr("beyond the end"));
    EXPECT_THAT(with([](json& root) { root["accessors"][0]["type"] = "VEC2"; }), HasSubstr("have 3 numbers"));
    EXPECT_THAT(with([](json& root) { root["bufferViews"][0]["byteLength"] = 1000000; }),
                HasSubstr("buffer"));
    EXPECT_THAT(with([](json& root) {
                    root["extensionsRequired"] = {"KHR_texture_basisu"};
                    root["meshes"] = "not looked at";
                }),
                HasSubstr("needs the extension KHR_texture_basisu"));
    EXPECT_THAT(with([](json& root) {
                    root.erase("scenes");
                    root.erase("nodes");
                }),
                HasSubstr("no scene"));
    EXPECT_THAT(with([](json& root) {
                    root["nodes"] = {{"name", json::object()}};
                }),
                HasSubstr("is of glTF 1"));
}

/// A pipe into which nothing is written would keep its reader waiting for ever.
TEST_F(GltfLoader, ImagesThatNoMaterialAsksForAreNotRead) {
    ASSERT_EQ(mkfifo(files_.path("a pipe.png").c_str(), 0600), 0);
    gltf_.root["images"] = {{{"uri", "a%20pipe.png"}}};
    gltf_.root["textures"] = {{{"source", 0}}};
    EXPECT_EQ(load().triangles.size(), 2u);
    gltf_.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    EXPECT_TRUE(has_note(load(), "it is a pipe"));
}

TEST_F(GltfLoader, ABufferInAPipeOrAFolderIsRefused) {
    ASSERT_EQ(mkfifo(files_.path("pipe").c_str(), 0600), 0);
    const auto with = [&](const std::string& member, const std::string& uri) {
        json file = {{"asset", {{"version", "2.0"}}}, {member, {{{"uri", uri}, {"byteLength", 12}}}}};
        return file_error([&] { load_scene(files_.write("file.gltf", file.dump())); });
    };
    EXPECT_THAT(with("buffers", "pipe"), HasSubstr("it is a pipe"));
    EXPECT_THAT(with("buffers", "."), HasSubstr("it is a folder"));
    // tinygltf decodes '%!Q' to a zero byte, where the system's functions end the path, which leaves the
    // folder.
    EXPECT_THAT(with("images", "%!QAAAQAAA5"), HasSubstr("no scene"));
}

TEST_F(GltfLoader, ABufferMayBeInTheFileOfAnImage) {
    json whole = gltf_.root;
    files_.write("both.png", gltf_.bytes);
    whole["buffers"] = {{{"byteLength", gltf_.bytes.size()}, {"uri", "both.png"}}};
    whole["images"] = {{{"uri", "both.png"}}};
    EXPECT_EQ(load_scene(files_.write("both.gltf", whole.dump())).triangles.size(), 2u);
}

TEST_F(GltfLoader, WhatIsCutShortOrNoGltfIsRefused) {
    const std::string binary = gltf_.binary();
    for (std::size_t length = 0; length < binary.size(); length += 1 + length / 3) {
        EXPECT_THAT(file_error([&] { load_scene(files_.write("cut.glb", binary.substr(0, length))); }),
                    HasSubstr("not a valid glTF"));
    }
    EXPECT_THAT(file_error([&] { load_scene(files_.write("no.gltf", "[]")); }),
                HasSubstr("no.gltf: not a valid glTF file: it is empty"));
    std::string old = binary;
    old[4] = 1;
    EXPECT_THAT(file_error([&] { load_scene(files_.write("old.glb", old)); }), HasSubstr("is of glTF 1"));
}

TEST_F(GltfLoader, BrokenJsonIsSaidToBeSoWithItsPlace) {
    struct Case {
        std::string text;
        const char* fault;
    };
    for (const Case& broken :
         {Case{"", "line 1, column 1: it ends too early, and may have been cut short"},
          {"{\"asset\": ", "line 1, column 11: it ends too early"},
          {"{\"asset\":\n {\"version\": tr", "line 2, column 16: it ends too early"},
          {"{\n  \"asset\": {\"version\": \"2.0\"}}\n}", "line 3, column 1: unexpected '}'"},
          {"hello", "line 1, column 1: unexpected 'h'"},
          {"{\"ä\": \xff}", "line 1, column 7: an unexpected character"},
          {"{\"a\x1b[31m\": 1}", "line 1, column 4: a text has a line break or another control character"},
          {"{\"a\nb\": 1}", "line 1, column 4: a text has a line break"},
          {"{\"a\": \"\xff\"}", "line 1, column 8: a text is not UTF-8"},
          {"{\"a\": \"\\x\"}", "line 1, column 9: a text is broken"},
          {"{\"a\": 1e999}", "line 1, column 11: a number is too large"}}) {
        const std::string path = files_.write("no.gltf", broken.text).string();
        const std::string error = file_error([&] { load_scene(path); });
        EXPECT_THAT(error,
                    HasSubstr(path + ": not a valid glTF file: its JSON is broken at " + broken.fault));
        EXPECT_TRUE(error.ends_with("; export the scene again, or correct it there")) << error;
        EXPECT_TRUE(std::ranges::all_of(error, [](char c) { return c >= 0x20 && c < 0x7f; })) << error;
    }
}

}  // namespace
}  // namespace nearlight::core
