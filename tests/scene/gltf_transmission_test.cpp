// SPDX-License-Identifier: Apache-2.0
// Frosted glass, and sheets through which light diffuses.
#include "host/scene/material_model.h"
#include "host/scene/texture.h"
#include "tests/scene/gltf_look.h"

namespace nearlight::core {
namespace {

using namespace test;

TEST_F(GltfLook, GlassBodiesAreFrostedInPlaces) {
    add_two_texels({1, 0, 1, 1, 1, 0.5f, 1, 1});  // green counts
    gltf_.material()["pbrMetallicRoughness"] = {
        {"metallicFactor", 0}, {"roughnessFactor", 0.8}, {"metallicRoughnessTexture", {{"index", 0}}}};
    extension("KHR_materials_transmission") = {{"transmissionFactor", 1}};
    extension("KHR_materials_volume") = {{"thicknessFactor", 1}};
    const Scene scene = load();
    const Material glass = top_material(scene);
    EXPECT_EQ(glass.model, NEARLIGHT_BSDF_DIELECTRIC);
    EXPECT_EQ(parameter_value(scene, glass.roughness, 0.25f, 0.5f).x, 0.0f);
    EXPECT_NEAR(parameter_value(scene, glass.roughness, 0.75f, 0.5f).x, 0.4f * 0.4f, 1e-4f);
    EXPECT_FALSE(has_note(scene, "roughness"));
    extension("KHR_materials_transmission")["transmissionFactor"] = 0.5;
    const Scene mixed = load();
    const Material half = mixed.materials.at(top_material(mixed).child[1]);
    EXPECT_NEAR(parameter_value(mixed, half.roughness, 0.75f, 0.5f).x, 0.4f * 0.4f, 1e-4f);
    EXPECT_NEAR(parameter_value(mixed, innermost(mixed).roughness, 0.75f, 0.5f).x, 0.4f, 1e-3f);
}

TEST_F(GltfLook, TexturesOfTheGlossinessOfGlassAreReplacedByTheirMeans) {
    add_two_texels({1, 1, 1, 1, 1, 1, 1, 0.5f});
    extension("KHR_materials_pbrSpecularGlossiness") = {{"specularFactor", {0.04, 0.04, 0.04}},
                                                        {"specularGlossinessTexture", {{"index", 0}}}};
    extension("KHR_materials_transmission") = {{"transmissionFactor", 1}};
    extension("KHR_materials_volume") = {{"thicknessFactor", 1}};
    const Scene scene = load();
    EXPECT_EQ(top_material(scene).model, NEARLIGHT_BSDF_DIELECTRIC);
    EXPECT_NEAR(top_material(scene).roughness.value.x, 0.25f * 0.25f, 1e-4f);
    EXPECT_EQ(top_material(scene).roughness.texture, -1);
    expect_note(scene, "textures of the glossiness of glass bodies are replaced by their means");
}

/// The sheet of a blend at the top, which lets all of its light through.
Material sheet_of(const Scene& scene) {
    EXPECT_EQ(top_material(scene).model, NEARLIGHT_BSDF_BLEND);
    Material sheet = scene.materials.at(top_material(scene).child[1]);
    EXPECT_EQ(sheet.model, NEARLIGHT_BSDF_PRINCIPLED);
    EXPECT_NE(sheet.flags & NEARLIGHT_MATERIAL_THIN, 0u);
    EXPECT_EQ(sheet.transmission.value.x, 1.0f);
    EXPECT_EQ(sheet.spec_trans.value.x, 0.0f);
    return sheet;
}

TEST_F(GltfLook, LightDiffusesThroughSheets) {
    gltf_.material()["pbrMetallicRoughness"] = {{"baseColorFactor", {0.2, 0.4, 0.6, 1}},
                                                {"metallicFactor", 0}};
    extension("KHR_materials_specular") = {{"specularFactor", 0}};
    extension("KHR_materials_diffuse_transmission") = {{"diffuseTransmissionFactor", 0.25},
                                                       {"diffuseTransmissionColorFactor", {0.8, 0.5, 0.3}}};
    gltf_.root["extensionsRequired"] = {"KHR_materials_diffuse_transmission"};
    const Scene scene = load();
    expect_close(sheet_of(scene).reflectance.value, {0.8f, 0.5f, 0.3f});
    EXPECT_FLOAT_EQ(top_material(scene).reflectance.value.x, 0.25f);
    EXPECT_EQ(innermost(scene).model, NEARLIGHT_BSDF_DIFFUSE);
    expect_close(innermost(scene).reflectance.value, {0.2f, 0.4f, 0.6f});
    EXPECT_FALSE(has_note(scene, "KHR_materials_diffuse_transmission"));
    extension("KHR_materials_diffuse_transmission")["diffuseTransmissionFactor"] = 0;
    EXPECT_EQ(top_material(load()).model, NEARLIGHT_BSDF_TWO_SIDED);
    extension("KHR_materials_diffuse_transmission")["diffuseTransmissionFactor"] = 1.5;
    EXPECT_EQ(top_material(load()).reflectance.value.x, 1.0f);
    expect_note(load(), "has a diffuseTransmissionFactor that is not between 0 and 1");
}

TEST_F(GltfLook, SheetsGetWhatReflectionsLeave) {
    gltf_.material()["pbrMetallicRoughness"] = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
    extension("KHR_materials_diffuse_transmission") = {{"diffuseTransmissionFactor", 1}};
    const Scene scene = load();
    const auto left = static_cast<float>(1 - mean_dielectric_reflectance(1.5));
    EXPECT_NEAR(sheet_of(scene).reflectance.value.x, left, 2e-3f);
    expect_note(scene, "KHR_materials_diffuse_transmission: reflections fade");
    extension("KHR_materials_volume") = {{"thicknessFactor", 1}};
    expect_note(load(), "KHR_materials_diffuse_transmission: bodies are taken for thin sheets");
}

TEST_F(GltfLook, TheAlphaOfATextureSaysHowMuchLightDiffusesThrough) {
    add_two_texels({0.5f, 0.25f, 1, 0.5f, 1, 1, 0, 0});
    gltf_.material()["pbrMetallicRoughness"] = {{"metallicFactor", 0}};
    extension("KHR_materials_specular") = {{"specularFactor", 0}};
    extension("KHR_materials_diffuse_transmission") = {{"diffuseTransmissionFactor", 0.5},
                                                       {"diffuseTransmissionTexture", {{"index", 0}}},
                                                       {"diffuseTransmissionColorFactor", {1, 0.5, 0.5}},
                                                       {"diffuseTransmissionColorTexture", {{"index", 0}}}};
    const Scene scene = load();
    const Parameter share = top_material(scene).reflectance;
    EXPECT_NEAR(parameter_value(scene, share, 0.25f, 0.5f).x, 0.25f, 1e-3f);
    EXPECT_EQ(parameter_value(scene, share, 0.75f, 0.5f).x, 0.0f);
    const Parameter color = sheet_of(scene).reflectance;
    expect_close(parameter_value(scene, color, 0.25f, 0.5f), {0.5f, 0.125f, 0.5f}, 1e-3f);
    expect_close(parameter_value(scene, color, 0.75f, 0.5f), {1, 0.5f, 0}, 1e-3f);
    json& base = gltf_.material()["pbrMetallicRoughness"];
    base["baseColorTexture"] = {{"index", 0}, {"texCoord", 1}};
    for (const std::string name : {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"}) {
        extension("KHR_materials_diffuse_transmission")[name]["texCoord"] = 2;
        EXPECT_THAT(error(), testing::HasSubstr("more than two sets")) << name;
        extension("KHR_materials_diffuse_transmission")[name]["texCoord"] = 0;
    }
}

TEST_F(GltfLook, NoLightDiffusesThroughMetal) {
    gltf_.material()["pbrMetallicRoughness"] = {{"metallicFactor", 0.25}};
    extension("KHR_materials_diffuse_transmission") = {{"diffuseTransmissionFactor", 0.5}};
    const Scene scene = load();
    const Material top = top_material(scene);
    ASSERT_EQ(top.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(top.reflectance.value.x, 0.25f);
    EXPECT_EQ(scene.materials.at(top.child[1]).model, NEARLIGHT_BSDF_TWO_SIDED);
    const Material rest = scene.materials.at(top.child[0]);
    ASSERT_EQ(rest.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(rest.reflectance.value.x, 0.5f);
    EXPECT_EQ(rest.child[0], top.child[1]);
    gltf_.material()["pbrMetallicRoughness"].erase("metallicFactor");  // so that it is 1
    EXPECT_EQ(top_material(load()).model, NEARLIGHT_BSDF_TWO_SIDED);
}

/// Glass takes its share of what diffuses through, too.
TEST_F(GltfLook, GlassIsBlendedWithSheets) {
    gltf_.material()["pbrMetallicRoughness"] = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
    extension("KHR_materials_diffuse_transmission") = {{"diffuseTransmissionFactor", 0.5}};
    extension("KHR_materials_transmission") = {{"transmissionFactor", 0.25}};
    const Scene scene = load();
    const Material top = top_material(scene);
    ASSERT_EQ(top.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(top.reflectance.value.x, 0.25f);
    EXPECT_EQ(scene.materials.at(top.child[1]).model, NEARLIGHT_BSDF_THIN_DIELECTRIC);
    const Material rest = scene.materials.at(top.child[0]);
    ASSERT_EQ(rest.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(rest.reflectance.value.x, 0.5f);
    extension("KHR_materials_transmission")["transmissionFactor"] = 1;
    EXPECT_EQ(top_material(load()).model, NEARLIGHT_BSDF_THIN_DIELECTRIC);
}

}  // namespace
}  // namespace nearlight::core
