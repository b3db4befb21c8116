// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_loader.h"

#include <gmock/gmock.h>

#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "host/image/image_io.h"
#include "host/scene/emitters.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using namespace test;

std::string base64(const std::string& bytes) {
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        uint word = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            word = word << 8u | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63u];
        }
    }
    return text;
}

/// A file in the making, all of whose numbers are in one buffer.
struct GltfText {
    json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},  {"nodes", {{{"mesh", 0}, {"name", "thing"}}}},
                 {"bufferViews", json::array()},  {"accessors", json::array()}};
    std::string bytes;

    int view(const std::string& data) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        root["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
        bytes += data;
        return static_cast<int>(root["bufferViews"].size() - 1);
    }
    template <typename T>
    static std::string raw(const std::vector<T>& values) {
        return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
    }
    template <typename T>
    int accessor(const std::vector<T>& values, int component_type, const char* type, std::size_t components,
                 bool normalized = false) {
        root["accessors"].push_back({{"bufferView", view(raw(values))},
                                     {"componentType", component_type},
                                     {"count", values.size() / components},
                                     {"type", type},
                                     {"normalized", normalized}});
        return static_cast<int>(root["accessors"].size() - 1);
    }
    int points(const std::vector<float>& values) { return accessor(values, 5126, "VEC3", 3); }

    /// A unit square in the plane z = 0, seen from +z, of material 0.
    void add_square() {
        const int positions = points({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        const int uvs = accessor(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2", 2);
        const int indices = accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
        root["meshes"] = {{{"primitives",
                            {{{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
                              {"indices", indices},
                              {"material", 0}}}}}};
        root["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
    }
    [[nodiscard]] json& primitive() { return root["meshes"][0]["primitives"][0]; }
    [[nodiscard]] json& material() { return root["materials"][0]; }

    [[nodiscard]] std::string text() const {
        json whole = root;
        whole["buffers"] = {
            {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        return whole.dump();
    }
    [[nodiscard]] std::string binary() const {
        json whole = root;
        whole["buffers"] = {{{"byteLength", bytes.size()}}};
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string data = bytes;
        data.resize((data.size() + 3) / 4 * 4);
        const auto word = [](std::size_t value) {
            return raw(std::vector{static_cast<std::uint32_t>(value)});
        };
        return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) + "JSON" + text +
               word(data.size()) + std::string("BIN\0", 4) + data;
    }
};

class GltfLoader : public testing::Test {
  protected:
    GltfLoader() { gltf_.add_square(); }
    Scene load(const LoadOptions& options = {}) const {
        return load_scene(files_.write("scene.gltf", gltf_.text()), options);
    }
    [[nodiscard]] std::string error() const {
        return file_error([&] { load(); });
    }
    [[nodiscard]] Material only_material() const {
        const Scene scene = load();
        return scene.materials.at(scene.triangles.at(0).material);
    }

    SceneFiles files_;
    GltfText gltf_;
};

void expect_close(Vec3 a, Vec3 b, float tolerance = 1e-5f) {
    EXPECT_LT(length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

Vec3 corner(const Scene& scene, std::size_t triangle, int k) {
    const Triangle& t = scene.triangles.at(triangle);
    return scene.vertices.at(k == 0 ? t.v0 : k == 1 ? t.v1 : t.v2).position;
}

TEST_F(GltfLoader, ReadsTrianglesAsTextAndAsBinary) {
    for (const bool binary : {false, true}) {
        const Scene scene = load_scene(binary ? files_.write("scene.glb", gltf_.binary())
                                              : files_.write("scene.gltf", gltf_.text()));
        ASSERT_EQ(scene.triangles.size(), 2u);
        expect_close(corner(scene, 0, 1), {1, 0, 0});
        expect_close(corner(scene, 1, 2), {0, 1, 0});
        expect_close(scene.vertices[0].normal, {0, 0, 1});
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

TEST_F(GltfLoader, Materials) {
    json& pbr = gltf_.material()["pbrMetallicRoughness"];
    pbr = {{"baseColorFactor", {0.2, 0.4, 0.6, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.9}};
    EXPECT_EQ(only_material().lobe, NEARLIGHT_LOBE_NONE);
    expect_close(only_material().base, {0.2f, 0.4f, 0.6f});
    EXPECT_NE(only_material().flags & NEARLIGHT_MATERIAL_TWO_SIDED, 0u);

    pbr["roughnessFactor"] = 0.3;
    EXPECT_EQ(only_material().lobe, NEARLIGHT_LOBE_COAT);
    EXPECT_FLOAT_EQ(only_material().roughness, 0.09f);
    EXPECT_FLOAT_EQ(only_material().eta.x, 1.5f);
    gltf_.material()["extensions"] = {{"KHR_materials_ior", {{"ior", 1.33}}}};
    EXPECT_FLOAT_EQ(only_material().eta.x, 1.33f);

    pbr["metallicFactor"] = 1;
    EXPECT_EQ(only_material().lobe, NEARLIGHT_LOBE_CONDUCTOR);
    expect_close(only_material().specular, {0.2f, 0.4f, 0.6f});

    gltf_.material()["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}};
    EXPECT_EQ(only_material().lobe, NEARLIGHT_LOBE_THIN_DIELECTRIC);
    gltf_.material()["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.1}};
    EXPECT_EQ(only_material().lobe, NEARLIGHT_LOBE_DIELECTRIC);
}

TEST_F(GltfLoader, EmissionIsARadiance) {
    gltf_.material()["emissiveFactor"] = {1, 0.5, 0};
    expect_close(only_material().emission, {1, 0.5f, 0});
    gltf_.material()["extensions"] = {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}};
    expect_close(only_material().emission, {8, 4, 0});
}

/// Two rows, red above blue.
std::string flag_png(const SceneFiles& files) {
    write_image(files.path("red flag.png"), {1, 2, {"R", "G", "B"}, {1, 0, 0, 0, 0, 1}});
    std::ifstream stream(files.path("red flag.png"), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(GltfLoader, TexturesInFilesAndInBuffers) {
    const std::string png = flag_png(files_);
    gltf_.material() = {
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}};
    gltf_.root["textures"] = {{{"source", 0}}};
    const json in_buffer = {{"bufferView", gltf_.view(png)}, {"mimeType", "image/png"}};
    for (const json& image : {json{{"uri", "red%20flag.png"}}, in_buffer,
                              json{{"uri", "data:image/png;base64," + base64(png)}}}) {
        SCOPED_TRACE(image.dump().substr(0, 60));
        gltf_.root["images"] = {image};
        const Scene scene = load();
        ASSERT_EQ(scene.images.size(), 1u) << to_string(scene.notes.back());
        EXPECT_EQ(scene.images[0].texels, (std::vector<std::uint32_t>{0xff0000ffu, 0xffff0000u}));
        EXPECT_EQ(scene.materials.at(0).base_texture, 0);
        expect_close(scene.materials.at(0).base, {1, 1, 1});
    }
    gltf_.root["bufferViews"].back()["byteLength"] = 1'000'000;
    for (const auto& [image, part] :
         {std::pair{json{{"uri", "missing.png"}}, "missing.png"}, {in_buffer, "beyond"}}) {
        gltf_.root["images"] = {image};
        const Scene grey = load();
        EXPECT_EQ(grey.materials.at(0).base_texture, -1);
        expect_close(grey.materials.at(0).base, {0.5f, 0.5f, 0.5f});
        EXPECT_THAT(grey.notes.at(0).text, HasSubstr(part));
    }
}

/// Where (u, v) of glTF, v downwards, looks up a texture; v downwards too.
std::array<float, 2> looked_up(const Texture& t, float u, float v) {
    const float up = 1 - v;
    return {t.u_scale * u + t.u_shear * up + t.u_offset, 1 - (t.v_shear * u + t.v_scale * up + t.v_offset)};
}

TEST_F(GltfLoader, TextureTransforms) {
    flag_png(files_);
    gltf_.root["textures"] = {{{"source", 0}}};
    gltf_.root["images"] = {{{"uri", "red%20flag.png"}}};
    json& info = gltf_.material()["pbrMetallicRoughness"]["baseColorTexture"];
    info = {{"index", 0},
            {"extensions",
             {{"KHR_texture_transform",
               {{"offset", {0.25, 0.5}}, {"scale", {2, 3}}, {"rotation", std::numbers::pi / 2}}}}}};
    gltf_.material()["pbrMetallicRoughness"]["metallicFactor"] = 0;
    const Texture texture = load().textures.at(0).parameters;
    // Scaled, turned counter-clockwise as one sees it (to the right becomes upwards), then moved.
    const auto origin = looked_up(texture, 0, 0);
    const auto right = looked_up(texture, 1, 0);
    const auto down = looked_up(texture, 0, 1);
    EXPECT_NEAR(origin[0], 0.25, 1e-5);
    EXPECT_NEAR(origin[1], 0.5, 1e-5);
    EXPECT_NEAR(right[0] - origin[0], 0, 1e-5);
    EXPECT_NEAR(right[1] - origin[1], -2, 1e-5);
    EXPECT_NEAR(down[0] - origin[0], 3, 1e-5);
    EXPECT_NEAR(down[1] - origin[1], 0, 1e-5);
}

TEST_F(GltfLoader, Lights) {
    gltf_.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 683}, {"color", {1, 0.5, 0}}},
        {{"type", "spot"}, {"intensity", 1366}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}},
        {{"type", "directional"}, {"intensity", 6830}}};
    gltf_.root["nodes"] = {{{"mesh", 0}, {"children", {1, 2, 3}}}};
    for (int light = 0; light < 3; ++light) {
        gltf_.root["nodes"].push_back({{"translation", {0, 0, light + 1}},
                                       {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    const Scene scene = load();
    ASSERT_EQ(scene.delta_emitters.size(), 3u);
    expect_close(scene.delta_emitters[0].position, {0, 0, 1});
    expect_close(scene.delta_emitters[0].radiance, {1, 0.5f, 0});
    EXPECT_EQ(scene.delta_emitters[1].type, NEARLIGHT_EMITTER_SPOT);
    expect_close(scene.delta_emitters[1].direction, {0, 0, -1});
    expect_close(scene.delta_emitters[1].radiance, {2, 2, 2});
    EXPECT_FLOAT_EQ(scene.delta_emitters[1].beam_angle, 0.2f);
    EXPECT_FLOAT_EQ(scene.delta_emitters[1].cutoff_angle, 0.4f);
    // At the middle of the scene, W/m².
    const Emitter& sun = scene.delta_emitters[2];
    const Vec3 to_middle = Vec3{0.5f, 0.5f, 0} - sun.position;
    EXPECT_NEAR(sun.radiance.x / dot(to_middle, to_middle), 10, 0.01);
    for (const Vertex& vertex : scene.vertices) {
        EXPECT_GT(dot(normalize(vertex.position - sun.position), sun.direction), std::cos(sun.beam_angle));
    }
    EXPECT_THAT(scene.notes.at(0).text, HasSubstr("directional"));
}

TEST_F(GltfLoader, CamerasLookAlongMinusZ) {
    gltf_.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}},
                             {{"type", "perspective"},
                              {"name", "wide"},
                              {"perspective", {{"yfov", 1.2}, {"aspectRatio", 2}, {"znear", 0.1}}}}};
    gltf_.root["nodes"] = {
        {{"mesh", 0}, {"children", {1, 2}}},
        {{"camera", 0}, {"name", "front"}, {"translation", {0, 0, 3}}, {"scale", {2, 2, 2}}},
        {{"camera", 1}}};
    const SceneCamera front = load().camera;
    expect_close(transform_vector(front.to_world, {0, 0, 1}), {0, 0, -1});
    expect_close(transform_vector(front.to_world, {0, 1, 0}), {0, 1, 0});
    expect_close(transform_vector(front.to_world, {1, 0, 0}), {-1, 0, 0});
    expect_close(transform_point(front.to_world, {0, 0, 0}), {0, 0, 3});
    EXPECT_EQ(front.width, 640);
    EXPECT_EQ(front.height, 480);
    EXPECT_NEAR(std::tan(front.fov_x_degrees * std::numbers::pi / 360), std::tan(0.4) * 4 / 3, 1e-6);

    const SceneCamera wide = load({.parameters = {{"camera", "wide"}}}).camera;
    EXPECT_EQ(wide.width, 960);
    EXPECT_NEAR(std::tan(wide.fov_x_degrees * std::numbers::pi / 360), 2 * std::tan(0.6), 1e-6);
    EXPECT_EQ(load({.parameters = {{"camera", "front"}}}).camera.width, 640);
    for (const auto& [name, value] : {std::pair{"camera", "back"}, {"kamera", "front"}}) {
        try {
            load({.parameters = {{name, value}}});
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
        }
    }
}

TEST_F(GltfLoader, WithoutCameraAndLightOnesAreMadeUp) {
    const Scene scene = load();
    EXPECT_EQ(scene.notes.size(), 2u);
    EXPECT_EQ(scene.environment.width, 1);
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
    EXPECT_THAT(with([](json& root) { root["nodes"][0]["children"] = {0}; }), HasSubstr("its own ancestor"));
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
    EXPECT_THAT(with([](json& root) { root["accessors"][0]["count"] = 5; }), HasSubstr("beyond the end"));
    EXPECT_THAT(with([](json& root) { root["accessors"][0]["count"] = 4000000000000; }),
                HasSubstr("accessor"));
    EXPECT_THAT(with([](json& root) { root["accessors"][0]["byteOffset"] = 4; }),
                HasSubstr("beyond the end"));
    EXPECT_THAT(with([](json& root) { root["accessors"][0]["type"] = "VEC2"; }), HasSubstr("3 numbers"));
    EXPECT_THAT(with([](json& root) { root["bufferViews"][0]["byteLength"] = 1000000; }),
                HasSubstr("buffer"));
    EXPECT_THAT(with([](json& root) { root["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
                HasSubstr("KHR_draco_mesh_compression"));
    EXPECT_THAT(with([](json& root) { root.erase("scenes"); }), HasSubstr("no scene"));
}

TEST_F(GltfLoader, WhatIsCutShortOrNoGltfIsRefused) {
    const std::string binary = gltf_.binary();
    for (std::size_t length = 0; length < binary.size(); length += 1 + length / 3) {
        EXPECT_THAT(file_error([&] { load_scene(files_.write("cut.glb", binary.substr(0, length))); }),
                    HasSubstr("not a valid glTF"));
    }
    EXPECT_THAT(file_error([&] { load_scene(files_.write("no.gltf", "{\"asset\": ")); }),
                HasSubstr("not a valid glTF"));
    EXPECT_THAT(file_error([&] { load_scene(files_.write("no.gltf", "[]")); }), HasSubstr("no.gltf"));
}

}  // namespace
}  // namespace nearlight::core
