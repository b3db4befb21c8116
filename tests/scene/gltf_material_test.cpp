// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <span>
#include <tuple>

#include "host/image/image_io.h"
#include "host/scene/texture.h"
#include "host/scene/transmission_curve.h"
#include "tests/scene/gltf_text.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using namespace test;

/// The material of the only triangle, without the wrapper that gives it two sides.
Material side_of(const Scene& scene) {
    const Material& material = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_EQ(material.model, NEARLIGHT_BSDF_TWO_SIDED);
    EXPECT_EQ(material.child[0], material.child[1]);
    return scene.materials.at(material.child[0]);
}

Material top_of(const Scene& scene) {
    return scene.materials.at(scene.triangles.at(0).material);
}

TEST_F(GltfLoader, Materials) {
    json& pbr = gltf_.material()["pbrMetallicRoughness"];
    pbr = {{"baseColorFactor", {0.2, 0.4, 0.6, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.3}};
    EXPECT_EQ(side_of(load()).model, NEARLIGHT_BSDF_PRINCIPLED);
    expect_close(side_of(load()).reflectance.value, {0.2f, 0.4f, 0.6f});
    EXPECT_EQ(side_of(load()).flags & NEARLIGHT_MATERIAL_LAYERED, NEARLIGHT_MATERIAL_LAYERED);
    EXPECT_FLOAT_EQ(side_of(load()).roughness.value.x, 0.3f);
    EXPECT_FLOAT_EQ(side_of(load()).eta.x, 1.5f);
    gltf_.material()["extensions"] = {{"KHR_materials_ior", {{"ior", 1.33}}}};
    EXPECT_FLOAT_EQ(side_of(load()).eta.x, 1.33f);

    pbr["metallicFactor"] = 1;
    EXPECT_EQ(side_of(load()).metallic.value.x, 1.0f);
    expect_close(side_of(load()).reflectance.value, {0.2f, 0.4f, 0.6f});
    EXPECT_NE(side_of(load()).curve, 0u);
}

/// A roughness of 1, which is the default, takes no reflections away; an index of 1 and a factor of 0 do.
TEST_F(GltfLoader, OnlyWhatReflectsNothingIsDiffuse) {
    gltf_.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}};
    const Scene scene = load();
    const Material cloth = side_of(scene);
    EXPECT_EQ(cloth.model, NEARLIGHT_BSDF_PRINCIPLED);
    EXPECT_EQ(cloth.roughness.value.x, 1.0f);
    EXPECT_FLOAT_EQ(cloth.eta.x, 1.5f);
    const TransmissionCurve rough = layered_curve({.eta = 1.5, .roughness = 1});
    const std::span<const float> curve =
        std::span(scene.transmission_curves).subspan(cloth.curve * std::size_t{NEARLIGHT_CURVE_SIZE});
    EXPECT_TRUE(std::equal(rough.begin(), rough.end(), curve.begin()));
    for (const auto& [extension, key, value] :
         {std::tuple{"KHR_materials_specular", "specularFactor", 0}, {"KHR_materials_ior", "ior", 1}}) {
        gltf_.material()["pbrMetallicRoughness"]["baseColorFactor"] = {0.2, 0.4, 0.6, 1};
        gltf_.material()["extensions"] = {{extension, {{key, value}}}};
        EXPECT_EQ(side_of(load()).model, NEARLIGHT_BSDF_DIFFUSE) << extension;
        expect_close(side_of(load()).reflectance.value, {0.2f, 0.4f, 0.6f});
    }
}

TEST_F(GltfLoader, WhatAMaterialMayNotSayIsNoted) {
    gltf_.material()["name"] = "paint";
    gltf_.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 0, 1, 1}}};
    gltf_.material()["alphaMode"] = "BLEND";
    EXPECT_FALSE(has_note(load(), "material 'paint'"));
    gltf_.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {2, 0.5, -1, 1}}};
    EXPECT_TRUE(has_note(load(), "material 'paint' has factors that are not between 0 and 1"));
    gltf_.material()["alphaMode"] = "DITHER";
    EXPECT_TRUE(has_note(load(), "material 'paint' has the unknown alphaMode 'DITHER'"));
    gltf_.material()["emissiveFactor"] = {1, 1, 1};
    gltf_.material()["extensions"] = {{"KHR_materials_emissive_strength", {{"emissiveStrength", -5}}},
                                      {"KHR_materials_ior", {{"ior", 0.5}}},
                                      {"KHR_materials_clearcoat", {{"clearcoatFactor", 7}}}};
    const Scene scene = load();
    EXPECT_TRUE(has_note(scene, "an emission below 0"));
    EXPECT_TRUE(has_note(scene, "an index (ior) below 1"));
    EXPECT_TRUE(has_note(scene, "a clearcoatFactor that is not between 0 and 1"));
    for (const Material& material : scene.materials) {
        EXPECT_GE(material.emission.value.x, 0.0f);
    }
    gltf_.material()["extensions"] = {{"KHR_materials_pbrSpecularGlossiness",
                                       {{"diffuseFactor", {2, -1, 0.5, 1}}, {"glossinessFactor", 3}}}};
    EXPECT_TRUE(has_note(load(), "a diffuseFactor that is not between 0 and 1"));
    EXPECT_TRUE(has_note(load(), "a glossinessFactor that is not between 0 and 1"));
}

TEST_F(GltfLoader, AWeakerSpecularFactorReflectsLess) {
    gltf_.material() = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
                        {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0.25}}}}}};
    const double eta = static_cast<double>(side_of(load()).eta.x);
    EXPECT_NEAR(std::pow((eta - 1) / (eta + 1), 2), 0.25 * 0.04, 1e-6);
    gltf_.material()["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
    EXPECT_EQ(side_of(load()).model, NEARLIGHT_BSDF_DIFFUSE);
    gltf_.material()["pbrMetallicRoughness"]["metallicFactor"] = 1;
    EXPECT_EQ(side_of(load()).model, NEARLIGHT_BSDF_PRINCIPLED) << "metal reflects whatever the factor is";
    EXPECT_FLOAT_EQ(side_of(load()).metallic.value.x, 1.0f);
}

TEST_F(GltfLoader, AnIndexOfZeroStandsForAnInfiniteOne) {
    gltf_.material() = {
        {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
        {"extensions",
         {{"KHR_materials_specular", {{"specularFactor", 0.25}}}, {"KHR_materials_ior", {{"ior", 0}}}}}};
    EXPECT_NEAR(side_of(load()).eta.x, 3.0f, 0.01f) << "a quarter of the light is reflected";
}

TEST_F(GltfLoader, ReflectionsDoNotChangeWhatGlassRefracts) {
    gltf_.material() = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                        {"extensions",
                         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                          {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                          {"KHR_materials_specular", {{"specularFactor", 0}}},
                          {"KHR_materials_ior", {{"ior", 1.7}}}}}};
    EXPECT_FLOAT_EQ(top_of(load()).eta.x, 1.7f);
    gltf_.material()["extensions"]["KHR_materials_ior"]["ior"] = 1;
    EXPECT_FLOAT_EQ(top_of(load()).eta.x, 1.001f) << "light goes straight on";
}

TEST_F(GltfLoader, MetalLetsNothingThrough) {
    gltf_.material() = {{"pbrMetallicRoughness", {{"metallicFactor", 0.25}, {"roughnessFactor", 0.5}}},
                        {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}};
    const Scene scene = load();
    const Material blend = top_of(scene);
    ASSERT_EQ(blend.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(blend.reflectance.value.x, 0.25f);
    EXPECT_EQ(scene.materials.at(scene.materials.at(blend.child[1]).child[0]).model,
              NEARLIGHT_BSDF_PRINCIPLED);
    const Material rest = scene.materials.at(blend.child[0]);
    ASSERT_EQ(rest.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(rest.reflectance.value.x, 1.0f) << "all of the rest is glass";
}

TEST_F(GltfLoader, TransmissionIsGlass) {
    gltf_.material() = {{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}, {"metallicFactor", 0}}},
                        {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}};
    EXPECT_EQ(top_of(load()).model, NEARLIGHT_BSDF_PRINCIPLED);
    EXPECT_NE(top_of(load()).flags & NEARLIGHT_MATERIAL_THIN, 0u);
    EXPECT_EQ(top_of(load()).spec_trans.value.x, 1.0f);
    gltf_.material()["pbrMetallicRoughness"]["roughnessFactor"] = 0;
    EXPECT_EQ(top_of(load()).model, NEARLIGHT_BSDF_THIN_DIELECTRIC);
    gltf_.material()["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
    gltf_.material()["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.1}};
    EXPECT_EQ(top_of(load()).model, NEARLIGHT_BSDF_DIELECTRIC);
    EXPECT_FLOAT_EQ(top_of(load()).roughness.value.x, 0.25f);
    gltf_.material()["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.3;
    const Scene scene = load();
    const Material blend = top_of(scene);
    EXPECT_EQ(blend.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(blend.reflectance.value.x, 0.3f);
    EXPECT_EQ(scene.materials.at(blend.child[0]).model, NEARLIGHT_BSDF_TWO_SIDED);
    EXPECT_EQ(scene.materials.at(blend.child[1]).model, NEARLIGHT_BSDF_DIELECTRIC);
}

TEST_F(GltfLoader, EmissionIsARadiance) {
    gltf_.material()["emissiveFactor"] = {1, 0.5, 0};
    expect_close(top_of(load()).emission.value, {1, 0.5f, 0});
    gltf_.material()["extensions"] = {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}};
    expect_close(top_of(load()).emission.value, {8, 4, 0});
}

/// A PNG file of two rows, red above blue.
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
        EXPECT_EQ(scene.images[0].format, NEARLIGHT_TEXELS_SRGB8);
        EXPECT_EQ(scene.images[0].words, (std::vector<std::uint32_t>{0xff0000ffu, 0xffff0000u}));
        EXPECT_EQ(side_of(scene).reflectance.texture, 0);
        expect_close(side_of(scene).reflectance.value, {1, 1, 1});
    }
    gltf_.root["bufferViews"].back()["byteLength"] = 1'000'000;
    for (const auto& [image, part] : {std::pair{json{{"uri", "missing.png"}}, "missing.png"},
                                      {json{{"uri", ""}}, "the URI of image 0 is empty"},
                                      {in_buffer, "beyond"}}) {
        gltf_.root["images"] = {image};
        const Scene grey = load();
        EXPECT_EQ(side_of(grey).reflectance.texture, -1);
        expect_close(side_of(grey).reflectance.value, {0.5f, 0.5f, 0.5f});
        EXPECT_THAT(grey.notes.at(0).text, HasSubstr(part));
    }
}

/// A scene with one texture of 2 × 1 texels: red with no alpha, blue with alpha ½; roughness 0 and metal 1
/// follow from the same numbers.
json alpha_texture(const SceneFiles& files) {
    write_image(files.path("alpha.exr"), {2, 1, {"R", "G", "B", "A"}, {1, 0, 0, 0, 0, 0, 1, 128 / 255.0f}});
    return {{{"uri", "alpha.exr"}}};
}

TEST_F(GltfLoader, AlphaMakesMasks) {
    gltf_.root["images"] = alpha_texture(files_);
    gltf_.root["textures"] = {{{"source", 0}}};
    gltf_.material() = {{"pbrMetallicRoughness",
                         {{"baseColorTexture", {{"index", 0}}}, {"baseColorFactor", {1, 1, 1, 0.5}}}}};
    EXPECT_EQ(top_of(load()).model, NEARLIGHT_BSDF_TWO_SIDED);  // opaque, whatever the alpha
    const auto opacity_at = [&](float u) {
        const Scene scene = load();
        EXPECT_EQ(top_of(scene).model, NEARLIGHT_BSDF_MASK);
        return parameter_value(scene, top_of(scene).reflectance, u, 0.5f).x;
    };
    gltf_.material()["alphaMode"] = "BLEND";
    EXPECT_EQ(opacity_at(0.25f), 0.0f);
    EXPECT_NEAR(opacity_at(0.75f), 0.25f, 2e-3f);
    gltf_.material()["alphaMode"] = "MASK";
    gltf_.material()["alphaCutoff"] = 0.25;  // times the factor, texels of alpha ½ pass
    EXPECT_EQ(opacity_at(0.25f), 0.0f);
    EXPECT_EQ(opacity_at(0.75f), 1.0f);
    gltf_.material()["alphaCutoff"] = 0.3;
    EXPECT_EQ(opacity_at(0.75f), 0.0f);
}

TEST_F(GltfLoader, RoughnessMetalnessAndNormalsAreTextured) {
    gltf_.root["images"] = alpha_texture(files_);
    gltf_.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    gltf_.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    gltf_.material() = {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}},
                        {"normalTexture", {{"index", 0}}}};
    const Scene scene = load();
    const Material map = top_of(scene);
    ASSERT_EQ(map.model, NEARLIGHT_BSDF_NORMAL_MAP);
    EXPECT_NE(map.flags & NEARLIGHT_MATERIAL_TANGENT, 0u);
    expect_close(parameter_value(scene, map.reflectance, 0.25f, 0.5f), {1, 0, 0});
    const Material side = scene.materials.at(scene.materials.at(map.child[0]).child[0]);
    EXPECT_EQ(parameter_value(scene, side.metallic, 0.25f, 0.5f).x, 0.0f);
    EXPECT_EQ(parameter_value(scene, side.metallic, 0.75f, 0.5f).x, 1.0f);
    EXPECT_EQ(parameter_value(scene, side.roughness, 0.25f, 0.5f).x, 0.0f);
    const TransmissionCurve smooth = layered_curve({.eta = 1.5, .roughness = 0});
    const std::span<const float> curve =
        std::span(scene.transmission_curves).subspan(side.curve * std::size_t{NEARLIGHT_CURVE_SIZE});
    EXPECT_TRUE(std::equal(smooth.begin(), smooth.end(), curve.begin())) << "that of the smoothest texel";
    const Texture& texture = scene.textures.at(static_cast<std::size_t>(side.roughness.texture)).parameters;
    EXPECT_EQ(texture.wrap_s, NEARLIGHT_WRAP_CLAMP);
    EXPECT_EQ(texture.wrap_t, NEARLIGHT_WRAP_MIRROR);
    EXPECT_EQ(texture.filter, NEARLIGHT_FILTER_NEAREST);
}

/// The place, with v downwards, at which glTF's (u, v), also with v downwards, looks up a texture.
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
    // The texture is scaled, then turned counter-clockwise as it appears (right becomes up), then moved.
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

/// Sets of texture coordinates are two at most, of those that can be seen.
TEST_F(GltfLoader, TexturesOutOfSightAskForNoCoordinates) {
    write_image(files_.path("texel.exr"), {1, 1, {"R", "G", "B"}, {1, 1, 1}});
    gltf_.root["images"] = {{{"uri", "texel.exr"}}};
    gltf_.root["textures"] = {{{"source", 0}}};
    const auto in_set = [](int set) { return json{{"index", 0}, {"texCoord", set}}; };
    json& pbr = gltf_.material()["pbrMetallicRoughness"];
    gltf_.material()["normalTexture"] = in_set(0);
    pbr = {{"baseColorTexture", in_set(1)}, {"metallicRoughnessTexture", in_set(2)}};
    EXPECT_THAT(error(), HasSubstr("more than two sets"));
    pbr["metallicFactor"] = 0;
    EXPECT_THAT(error(), HasSubstr("more than two sets"));
    pbr["roughnessFactor"] = 0;
    EXPECT_EQ(load().triangles.size(), 2u);
    pbr["roughnessFactor"] = 1;
    pbr["baseColorFactor"] = {0, 0, 0, 1};
    EXPECT_EQ(load().triangles.size(), 2u);
    gltf_.material()["alphaMode"] = "BLEND";  // the texture's alpha counts
    EXPECT_THAT(error(), HasSubstr("more than two sets"));
    gltf_.material()["alphaMode"] = "OPAQUE";
    pbr = {{"baseColorTexture", in_set(1)}};
    gltf_.material()["extensions"]["KHR_materials_pbrSpecularGlossiness"]["diffuseTexture"] = in_set(2);
    EXPECT_EQ(load().triangles.size(), 2u) << "the other base is used";
}

}  // namespace
}  // namespace nearlight::core
