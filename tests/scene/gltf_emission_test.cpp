// SPDX-License-Identifier: Apache-2.0
// What glTF surfaces emit, and how much of it their holes leave.
#include "host/scene/texture.h"
#include "tests/scene/gltf_look.h"

namespace nearlight::core {
namespace {

using namespace test;

TEST_F(GltfLook, UnlitSurfacesShineWithTheirColour) {
    gltf_.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {0.2, 0.4, 0.6, 1}}};
    extension("KHR_materials_unlit") = json::object();
    const Scene scene = load();
    expect_close(top_material(scene).emission.value, {0.2f, 0.4f, 0.6f});
    EXPECT_TRUE(is_zero(innermost(scene).reflectance.value));
    expect_note(scene, "KHR_materials_unlit");
}

TEST_F(GltfLook, HolesOfUnlitSurfacesDoNotShine) {
    add_texel({1, 1, 1, 0.25f});
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"alphaMode", "BLEND"}};
    extension("KHR_materials_unlit") = json::object();
    const Scene scene = load();
    EXPECT_NEAR(parameter_value(scene, top_material(scene).emission, 0.5f, 0.5f).x, 0.25f, 1e-3f);
    EXPECT_NEAR(parameter_value(scene, top_material(scene).reflectance, 0.5f, 0.5f).x, 0.25f, 1e-3f);
}

TEST_F(GltfLook, TheAlphaOfVerticesDimsUnlitSurfaces) {
    add_texel({0.5f, 1, 1, 1});
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.8, 0.8, 1}}}},
                        {"alphaMode", "BLEND"}};
    extension("KHR_materials_unlit") = json::object();
    const std::vector<float> colors{0.5f, 0.5f, 0.5f, 0.25f, 0.5f, 0.5f, 0.5f, 0.25f,
                                    0.5f, 0.5f, 0.5f, 0.25f, 0.5f, 0.5f, 0.5f, 0.25f};
    gltf_.primitive()["attributes"]["COLOR_0"] = gltf_.accessor(colors, 5126, "VEC4", 4);
    const auto emission = [&] {
        const Scene scene = load();
        return parameter_value(scene, top_material(scene).emission, 0.5f, 0.5f, scene.vertex_colors.at(0));
    };
    expect_close(emission(), {0.1f, 0.1f, 0.1f}, 1e-6f);
    EXPECT_FALSE(has_note(load(), "alpha of vertex colours"));
    gltf_.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    expect_close(emission(), {0.05f, 0.1f, 0.1f}, 1e-3f);
    gltf_.material()["pbrMetallicRoughness"].erase("baseColorTexture");
    gltf_.material()["alphaMode"] = "MASK";
    expect_note(load(), "surfaces shine in the holes that the alpha of vertex colours makes");
}

TEST_F(GltfLook, HolesShineAsMuchAsTheyAreFilled) {
    add_texel({1, 1, 1, 0.5f});
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}},
                        {"alphaMode", "BLEND"},
                        {"emissiveFactor", {1, 0.5, 0}}};
    const auto emission = [&] {
        const Scene scene = load();
        return parameter_value(scene, top_material(scene).emission, 0.5f, 0.5f);
    };
    expect_close(emission(), {0.5f, 0.25f, 0});
    gltf_.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    expect_close(emission(), {0.25f, 0.125f, 0}, 1e-3f);
    gltf_.material()["emissiveTexture"] = {{"index", 0}};
    expect_close(emission(), {0.25f, 0.125f, 0}, 1e-3f);
    gltf_.material()["alphaMode"] = "MASK";
    gltf_.material()["alphaCutoff"] = 0.2;
    expect_close(emission(), {1, 0.5f, 0}, 1e-3f);
    gltf_.material()["alphaCutoff"] = 0.3;
    expect_close(emission(), {0, 0, 0});
    gltf_.material().erase("emissiveTexture");
    expect_close(emission(), {0, 0, 0});
    gltf_.material()["alphaCutoff"] = 0.6;  // above the factor, so that no texel passes
    expect_close(emission(), {0, 0, 0});
    gltf_.material()["alphaMode"] = "OPAQUE";
    expect_close(emission(), {1, 0.5f, 0});
    extension("KHR_materials_unlit") = json::object();
    gltf_.material()["alphaMode"] = "BLEND";
    expect_close(emission(), {0.25f, 0.25f, 0.25f}, 1e-3f);
}

/// Two textures are one image if they agree in the format that is read.
TEST_F(GltfLook, HolesOfOtherImagesAreNoted) {
    add_texel({1, 1, 1, 0.5f});
    gltf_.root["images"].push_back({{"uri", "other.exr"}});
    write_image(files_.path("other.exr"), {1, 1, {"R", "G", "B"}, {1, 1, 1}});
    gltf_.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"alphaMode", "BLEND"},
                        {"emissiveTexture", {{"index", 1}}},
                        {"emissiveFactor", {1, 1, 1}}};
    const Scene scene = load();
    expect_close(parameter_value(scene, top_material(scene).emission, 0.5f, 0.5f), {1, 1, 1}, 1e-3f);
    expect_note(scene, "shine in the holes");
    gltf_.root["textures"][1] = {{"source", 1}, {"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
    const Scene shared = load();
    expect_close(parameter_value(shared, top_material(shared).emission, 0.5f, 0.5f), {0.5f, 0.5f, 0.5f},
                 1e-3f);
    EXPECT_FALSE(has_note(shared, "shine in the holes"));
}

/// As in an atlas: what shines is elsewhere in the image, where alpha says nothing of holes.
TEST_F(GltfLook, HolesOfOtherPlacesOfAnImageAreNoted) {
    add_texel({1, 1, 1, 0.5f});
    gltf_.root["samplers"] = {{{"magFilter", 9728}}};  // nearest
    gltf_.root["textures"] = {{{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
    const auto shines = [&](const json& emissive) {
        gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                            {"alphaMode", "BLEND"},
                            {"emissiveTexture", emissive},
                            {"emissiveFactor", {1, 1, 1}}};
        const Scene scene = load();
        const float emission = parameter_value(scene, top_material(scene).emission, 0.5f, 0.5f).x;
        EXPECT_EQ(has_note(scene, "shine in the holes"), emission > 0.75f);
        return emission;
    };
    const json by_half = {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}};
    const json by_nothing = {{"KHR_texture_transform", {{"offset", {0, 0}}}}};
    EXPECT_NEAR(shines({{"index", 0}}), 0.5f, 1e-3f);
    EXPECT_NEAR(shines({{"index", 0}, {"extensions", by_nothing}}), 0.5f, 1e-3f);
    EXPECT_NEAR(shines({{"index", 0}, {"extensions", by_half}}), 1, 1e-3f);
    EXPECT_NEAR(shines({{"index", 0}, {"texCoord", 1}}), 1, 1e-3f);
    EXPECT_NEAR(shines({{"index", 1}}), 1, 1e-3f);
}

/// A tetrahedron around the origin, as of a sky box; a front that is outside is dark inside.
TEST_F(GltfLook, TheBackOfAClosedSurfaceShinesWhereTheCameraSeesIt) {
    gltf_.material() = {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}};
    const std::vector<std::uint16_t> outwards{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const std::vector<std::uint16_t> inwards{0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
    gltf_.primitive()["attributes"] = {
        {"POSITION", gltf_.points({-1, -1, -1, 3, -1, -1, -1, 3, -1, -1, -1, 3})}};
    const std::array<double, 3> inside{0, 0, 0};
    const std::array<double, 3> outside{1, 1.5, 1};
    const auto triangles = [&](const std::vector<std::uint16_t>& indices, const std::array<double, 3>& eye) {
        gltf_.primitive()["indices"] = gltf_.accessor(indices, 5123, "SCALAR", 1);
        return load({.overrides = {.origin = eye}}).triangles.size();
    };
    for (const double x : {1, -1}) {
        gltf_.root["nodes"][0]["scale"] = {x, 1, 1};
        EXPECT_EQ(triangles(outwards, inside), 8u);
        EXPECT_EQ(triangles(outwards, outside), 4u);
        EXPECT_EQ(triangles(inwards, inside), 4u);
        EXPECT_EQ(triangles(inwards, outside), 8u);
    }
    const Scene scene = load({.overrides = {.origin = outside}});
    EXPECT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.object_names.at(1), "thing");
    gltf_.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    gltf_.root["nodes"] = {{{"mesh", 0}}, {{"camera", 0}, {"translation", {0, 0, 0}}}};
    gltf_.root["scenes"][0]["nodes"] = {0, 1};
    EXPECT_EQ(load().triangles.size(), 4u) << "the camera of the file is inside, as the front is";
}

}  // namespace
}  // namespace nearlight::core
