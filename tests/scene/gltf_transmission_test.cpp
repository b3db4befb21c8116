// SPDX-License-Identifier: Apache-2.0
// Frosted glass.
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

}  // namespace
}  // namespace nearlight::core
