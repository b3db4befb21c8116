// SPDX-License-Identifier: Apache-2.0
// Extensions of glTF materials, and what is noted where the scene's materials cannot do the same.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "host/scene/texture.h"
#include "tests/scene/gltf_look.h"

namespace nearlight::core {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::Not;
using namespace test;

TEST_F(GltfLook, ClearcoatAndSheenAreThoseOfThePrincipledModel) {
    add_texel({0.5f, 0, 0, 1});
    extension("KHR_materials_clearcoat") = {{"clearcoatFactor", 0.8}, {"clearcoatTexture", {{"index", 0}}}};
    extension("KHR_materials_sheen") = {{"sheenColorFactor", {0.5, 0.5, 0.5}}};
    const Scene scene = load();
    const Material side = innermost(scene);
    EXPECT_EQ(side.model, NEARLIGHT_BSDF_PRINCIPLED);
    EXPECT_NEAR(parameter_value(scene, side.clearcoat, 0.5f, 0.5f).x, 0.4f, 1e-3f);
    EXPECT_FLOAT_EQ(side.clearcoat_gloss.value.x, 1.0f);
    EXPECT_FLOAT_EQ(side.sheen.value.x, 0.5f);
    expect_note(scene, "KHR_materials_clearcoat");
    expect_note(scene, "KHR_materials_sheen");
}

/// What the principled model makes of its roughness and its anisotropy: α along u and along v.
std::array<double, 2> alphas_of(const Material& side) {
    const double aspect = std::sqrt(1 - 0.9 * static_cast<double>(side.anisotropic.value.x));
    const double squared = std::pow(static_cast<double>(side.roughness.value.x), 2);
    return {squared / aspect, squared * aspect};
}

TEST_F(GltfLook, AnisotropyStretchesReflectionsAlongU) {
    gltf_.material()["pbrMetallicRoughness"] = {{"roughnessFactor", 0.5}};  // α is ¼
    json& anisotropy = extension("KHR_materials_anisotropy");
    anisotropy = {{"anisotropyStrength", 0.5}};
    const Scene scene = load();
    const Material side = innermost(scene);
    EXPECT_NE(side.flags & NEARLIGHT_MATERIAL_TANGENT, 0u);
    EXPECT_NEAR(alphas_of(side)[0], 0.25 + 0.75 * 0.25, 1e-6);  // mix(α, 1, strength²)
    EXPECT_NEAR(alphas_of(side)[1], 0.25, 1e-6);
    EXPECT_FALSE(has_note(scene, "KHR_materials_anisotropy"));
    gltf_.material()["pbrMetallicRoughness"]["roughnessFactor"] = 0.1;
    anisotropy["anisotropyStrength"] = 1;
    const Scene strong = load();
    EXPECT_NEAR(alphas_of(innermost(strong))[0], std::sqrt(10) * std::sqrt(0.01), 1e-4);
    EXPECT_NEAR(alphas_of(innermost(strong))[1], std::sqrt(0.1) * std::sqrt(0.01), 1e-4);
    expect_note(strong, "KHR_materials_anisotropy stretches reflections up to tenfold");
    anisotropy["anisotropyRotation"] = 1;
    const Scene turned = load();
    EXPECT_EQ(innermost(turned).anisotropic.value.x, 0.0f);
    EXPECT_EQ(innermost(turned).roughness.value.x, 0.1f);
    expect_note(turned, "KHR_materials_anisotropy is left out");
}

TEST_F(GltfLook, AnisotropyDoesNotFrostGlass) {
    gltf_.material()["pbrMetallicRoughness"] = {{"metallicFactor", 0}, {"roughnessFactor", 0.25}};
    extension("KHR_materials_volume") = {{"thicknessFactor", 1}};
    extension("KHR_materials_anisotropy") = {{"anisotropyStrength", 0.5}};
    extension("KHR_materials_transmission") = {{"transmissionFactor", 1}};
    const Scene glass = load();
    EXPECT_FLOAT_EQ(top_material(glass).roughness.value.x, 0.0625f);
    expect_note(glass, "KHR_materials_anisotropy is left out of glass");
    extension("KHR_materials_transmission")["transmissionFactor"] = 0.5;
    const Scene blend = load();
    const Material top = top_material(blend);
    ASSERT_EQ(top.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_FLOAT_EQ(blend.materials.at(top.child[1]).roughness.value.x, 0.0625f);
    Material opaque = blend.materials.at(top.child[0]);
    while (opaque.model >= NEARLIGHT_BSDF_MASK) {
        opaque = blend.materials.at(opaque.child[0]);
    }
    EXPECT_NEAR(alphas_of(opaque)[0], 0.0625 + 0.9375 * 0.25, 1e-6);
    EXPECT_NEAR(alphas_of(opaque)[1], 0.0625, 1e-6);
    expect_note(blend, "KHR_materials_anisotropy is left out of glass");
}

TEST_F(GltfLook, TransmissionIsTextured) {
    add_texel({0.5f, 0, 0, 1});
    extension("KHR_materials_transmission") = {{"transmissionFactor", 0.5},
                                               {"transmissionTexture", {{"index", 0}}}};
    const Scene scene = load();
    const Material blend = top_material(scene);
    ASSERT_EQ(blend.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_NEAR(parameter_value(scene, blend.reflectance, 0.5f, 0.5f).x, 0.25f, 1e-3f);
}

TEST_F(GltfLook, BodiesAbsorbAtTheirFaces) {
    extension("KHR_materials_transmission") = {{"transmissionFactor", 1}};
    extension("KHR_materials_volume") = {
        {"thicknessFactor", 2}, {"attenuationDistance", 1}, {"attenuationColor", {0.5, 1, 0.25}}};
    const Scene scene = load();
    const Vec3 face = top_material(scene).transmission.value;
    expect_close(face * face, {0.25f, 1, 0.0625f});  // both faces together: 2 m
    expect_note(scene, "KHR_materials_volume");
}

TEST_F(GltfLook, LargerBodiesAbsorbMore) {
    extension("KHR_materials_transmission") = {{"transmissionFactor", 1}};
    extension("KHR_materials_volume") = {
        {"thicknessFactor", 2}, {"attenuationDistance", 1}, {"attenuationColor", {0.5, 1, 0.25}}};
    const auto through = [&] {
        const Vec3 face = top_material(load()).transmission.value;
        return face * face;
    };
    gltf_.root["nodes"][0]["scale"] = {0.5, 0.5, 0.5};
    expect_close(through(), {0.5f, 1, 0.25f});  // the body is 1 m thick
    gltf_.root["nodes"][0]["scale"] = {-4, 0.5, 0.5};
    expect_close(through(), {0.25f, 1, 0.0625f});  // which is as large as one of the scale 1
    extension("KHR_materials_volume")["thicknessTexture"] = {{"index", 0}};
    add_texel({0, 0.5f, 1, 1});  // green counts
    expect_close(through(), {0.5f, 1, 0.25f});
    expect_note(load(), "thicknessTexture is replaced by its mean");
}

TEST_F(GltfLook, BodiesOfOneScaleShareAMaterial) {
    gltf_.root["nodes"] = {{{"mesh", 0}, {"scale", {3, 3, 3}}},
                           {{"mesh", 0}, {"scale", {3, 3, 3}}, {"rotation", {0.6, 0, 0, 0.8}}},
                           {{"mesh", 0}}};
    gltf_.root["scenes"][0]["nodes"] = {0, 1, 2};
    extension("KHR_materials_transmission") = {{"transmissionFactor", 1}};
    extension("KHR_materials_volume") = {{"thicknessFactor", 1}};
    EXPECT_EQ(load().materials.size(), 1u) << "clear glass does not depend on the scale";
    extension("KHR_materials_volume")["attenuationDistance"] = 1;
    extension("KHR_materials_volume")["attenuationColor"] = {0.5, 0.5, 0.5};
    const Scene scene = load();
    EXPECT_EQ(scene.triangles.at(0).material, scene.triangles.at(2).material);
    EXPECT_NE(scene.triangles.at(0).material, scene.triangles.at(4).material);
}

TEST_F(GltfLook, SpecularGlossinessIsConverted) {
    add_texel({1, 1, 1, 0.5f});
    extension("KHR_materials_pbrSpecularGlossiness") = {{"diffuseFactor", {0.1, 0.2, 0.3, 1}},
                                                        {"specularFactor", {0.04, 0.04, 0.04}},
                                                        {"glossinessFactor", 0.75}};
    const Material dielectric = innermost(load());
    // What is reflected is taken from the diffuse colour.
    expect_close(dielectric.reflectance.value, {0.096f, 0.192f, 0.288f});
    EXPECT_NEAR(dielectric.eta.x, 1.5f, 1e-5f);
    EXPECT_FLOAT_EQ(dielectric.roughness.value.x, 0.25f);
    extension("KHR_materials_pbrSpecularGlossiness")["specularFactor"] = {0.9, 0.6, 0.3};
    const Material metal = innermost(load());
    EXPECT_EQ(metal.metallic.value.x, 1.0f);
    expect_close(metal.reflectance.value, {0.9f, 0.6f, 0.3f});
    extension("KHR_materials_pbrSpecularGlossiness")["specularGlossinessTexture"] = {{"index", 0}};
    const Scene textured = load();
    EXPECT_NEAR(parameter_value(textured, innermost(textured).roughness, 0.5f, 0.5f).x, 1 - 0.375f, 1e-3f);
    extension("KHR_materials_pbrSpecularGlossiness") = json::object();  // all is 1: a mirror
    const Material mirror = innermost(load());
    EXPECT_EQ(mirror.metallic.value.x, 1.0f);
    EXPECT_EQ(mirror.roughness.value.x, 0.0f);
    expect_close(mirror.reflectance.value, {1, 1, 1});
}

/// A texture of cloth beside copper.
TEST_F(GltfLook, SpecularTexturesSayWhatIsMetal) {
    add_two_texels({0.04f, 0.04f, 0.04f, 1, 0.95f, 0.64f, 0.54f, 0.5f});
    json& look = extension("KHR_materials_pbrSpecularGlossiness");
    look = {{"diffuseFactor", {0.5, 0.4, 0.3, 1}}, {"specularGlossinessTexture", {{"index", 0}}}};
    const Scene scene = load();
    const Material blend = top_material(scene);
    ASSERT_EQ(blend.model, NEARLIGHT_BSDF_BLEND);
    EXPECT_EQ(parameter_value(scene, blend.reflectance, 0.25f, 0.5f).x, 0.0f);
    EXPECT_EQ(parameter_value(scene, blend.reflectance, 0.75f, 0.5f).x, 1.0f);
    const Material cloth = scene.materials.at(scene.materials.at(blend.child[0]).child[0]);
    EXPECT_EQ(cloth.metallic.value.x, 0.0f);
    expect_close(cloth.reflectance.value, {0.48f, 0.384f, 0.288f}, 1e-4f);
    EXPECT_EQ(cloth.reflectance.texture, -1);
    EXPECT_NEAR(cloth.eta.x, 1.5f, 1e-3f);
    const Material metal = scene.materials.at(scene.materials.at(blend.child[1]).child[0]);
    EXPECT_EQ(metal.metallic.value.x, 1.0f);
    expect_close(parameter_value(scene, metal.reflectance, 0.75f, 0.5f), {0.95f, 0.64f, 0.54f}, 1e-3f);
    for (const Material& side : {cloth, metal}) {
        EXPECT_NEAR(parameter_value(scene, side.roughness, 0.75f, 0.5f).x, 0.5f, 1e-3f);
    }
    look["specularFactor"] = {0.3, 0.3, 0.3};
    const Scene dark = load();
    ASSERT_EQ(top_material(dark).model, NEARLIGHT_BSDF_TWO_SIDED) << "nothing reflects like metal";
    EXPECT_EQ(innermost(dark).metallic.value.x, 0.0f);
    look["specularFactor"] = {0.5, 0.5, 0.5};
    EXPECT_EQ(top_material(load()).model, NEARLIGHT_BSDF_BLEND);
}

TEST_F(GltfLook, NormalMapsHaveTheirScaleAndKnowMirroredCoordinates) {
    add_texel({0.75f, 0.75f, 1, 1});
    gltf_.material()["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
    const Scene scene = load();
    expect_close(parameter_value(scene, top_material(scene).reflectance, 0.5f, 0.5f), {0.625f, 0.625f, 1},
                 1e-3f);
    gltf_.primitive()["attributes"]["TEXCOORD_0"] =
        gltf_.accessor(std::vector<float>{1, 1, 0, 1, 0, 0, 1, 0}, 5126, "VEC2", 2);
    const Scene mirrored = load();
    expect_close(parameter_value(mirrored, top_material(mirrored).reflectance, 0.5f, 0.5f),
                 {0.625f, 0.375f, 1}, 1e-3f);
    gltf_.root["nodes"][0]["scale"] = {1, -1, 1};
    const Scene twice = load();  // and so as it was
    expect_close(parameter_value(twice, top_material(twice).reflectance, 0.5f, 0.5f), {0.625f, 0.625f, 1},
                 1e-3f);
}

/// The directions of a map are those in which its own coordinates grow, unless the mesh has tangents.
TEST_F(GltfLook, TextureTransformsTurnNormalMaps) {
    constexpr double kRight = std::numbers::pi / 2;
    add_texel({0.75f, 0.5625f, 1, 1});  // (x, y) = (0.5, 0.125)
    const auto normal = [&](const json& transform) {
        gltf_.material()["normalTexture"] = {{"index", 0},
                                             {"extensions", {{"KHR_texture_transform", transform}}}};
        const Scene scene = load();
        EXPECT_EQ(has_note(scene, "keep angles"), transform.value("rotation", 0.0) == kRight / 2);
        return 2 * parameter_value(scene, top_material(scene).reflectance, 0.5f, 0.5f) - Vec3{1, 1, 1};
    };
    expect_close(normal({{"offset", {0.5, 0.25}}, {"scale", {2, 3}}}), {0.5f, 0.125f, 1}, 1e-3f);
    // With u' = v, where v goes down, the map's x goes down, and its y goes to the right.
    expect_close(normal({{"rotation", kRight}}), {0.125f, -0.5f, 1}, 1e-3f);
    expect_close(normal({{"scale", {-1, 1}}}), {-0.5f, 0.125f, 1}, 1e-3f);
    expect_close(normal({{"scale", {1, -2}}}), {0.5f, -0.125f, 1}, 1e-3f);
    expect_close(normal({{"rotation", kRight}, {"scale", {-1, 1}}}), {-0.125f, -0.5f, 1}, 1e-3f);
    const float root = std::sqrt(0.5f);
    expect_close(normal({{"rotation", kRight / 2}}), {0.625f * root, -0.375f * root, 1}, 1e-3f);
    const std::vector<float> tangents{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    gltf_.primitive()["attributes"]["TANGENT"] = gltf_.accessor(tangents, 5126, "VEC4", 4);
    expect_close(normal({{"rotation", kRight}}), {0.5f, 0.125f, 1}, 1e-3f);
}

TEST_F(GltfLook, TangentsThatDifferFromTheTextureCoordinatesAreNoted) {
    add_texel({0.75f, 0.75f, 1, 1});
    gltf_.material()["normalTexture"] = {{"index", 0}};
    const auto is_noted = [&](const std::vector<float>& tangent) {
        std::vector<float> tangents;
        for (int vertex = 0; vertex < 4; ++vertex) {
            tangents.insert(tangents.end(), tangent.begin(), tangent.end());
        }
        gltf_.primitive()["attributes"]["TANGENT"] = gltf_.accessor(tangents, 5126, "VEC4", 4);
        return has_note(load(), "TANGENT differs");
    };
    EXPECT_FALSE(is_noted({1, 0, 0, 1}));
    EXPECT_TRUE(is_noted({0, 1, 0, 1}));
    EXPECT_TRUE(is_noted({1, 0, 0, -1}));
    gltf_.primitive()["attributes"]["TEXCOORD_0"] =
        gltf_.accessor(std::vector<float>{1, 1, 0, 1, 0, 0, 1, 0}, 5126, "VEC2", 2);
    EXPECT_FALSE(is_noted({-1, 0, 0, -1})) << "mirrored";
    gltf_.primitive()["attributes"]["TEXCOORD_0"] =
        gltf_.accessor(std::vector<float>(8, 0.5f), 5126, "VEC2", 2);
    EXPECT_FALSE(is_noted({0, 1, 0, 1})) << "these coordinates have no directions";
}

/// A square beside its mirror image: one mesh in two placements, of which the second one mirrors.
TEST_F(GltfLook, PlacementsThatMirrorTurnNormalMapsOver) {
    add_texel({0.75f, 0.75f, 1, 1});
    gltf_.material()["normalTexture"] = {{"index", 0}};
    gltf_.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"scale", {-1, 1, 1}}}};
    gltf_.root["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), 4u);
    const auto normals = [&](std::size_t triangle) {
        const Material& map = scene.materials.at(scene.triangles[triangle].material);
        return parameter_value(scene, map.reflectance, 0.5f, 0.5f);
    };
    expect_close(normals(0), {0.75f, 0.75f, 1}, 1e-3f);
    expect_close(normals(2), {0.75f, 0.25f, 1}, 1e-3f);
}

TEST_F(GltfLook, ImagesOfOtherKindsInDataUris) {
    const std::string red = "UklGRhwAAABXRUJQVlA4TA8AAAAvAAAAAAcQ/Y/+ByKi/wEA";
    gltf_.root["images"] = {{{"uri", "data:image/webp;base64," + red}}};
    gltf_.root["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"extensions", {{"KHR_materials_unlit", json::object()}}}};
    const Scene scene = load();
    expect_close(parameter_value(scene, top_material(scene).emission, 0.5f, 0.5f), {1, 0, 0}, 1e-3f);
}

TEST_F(GltfLook, WebPThatCannotBeReadIsReplacedByTheImageBesideIt) {
    add_texel({1, 0.5f, 0, 1});
    files_.write("broken.webp", "RIFF");
    gltf_.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                        {"extensions", {{"KHR_materials_unlit", json::object()}}}};
    const auto color = [&](const json& webp) {
        gltf_.root["images"] = {{{"uri", "texel.exr"}}, webp};
        gltf_.root["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
        const Scene scene = load();
        return parameter_value(scene, top_material(scene).emission, 0.5f, 0.5f);
    };
    for (const json& webp : {json{{"uri", "broken.webp"}}, json{{"uri", "missing.webp"}},
                             json{{"bufferView", gltf_.view("RIFF")}, {"mimeType", "image/webp"}}}) {
        expect_close(color(webp), {1, 0.5f, 0}, 1e-3f);
        expect_note(load(), "EXT_texture_webp: what cannot be read is replaced by the image beside it");
        EXPECT_THAT(load().notes, Not(Contains(Field(&Note::text, HasSubstr("mid-grey")))));
    }
    std::filesystem::remove(files_.path("texel.exr"));
    expect_close(color({{"uri", "missing.webp"}}), {0.5f, 0.5f, 0.5f});
    expect_note(load(), "texture is replaced by mid-grey because it cannot be read");
}

TEST_F(GltfLook, FactorsOfZeroWinOverTextures) {
    add_texel({1, 1, 1, 1});
    gltf_.material()["pbrMetallicRoughness"] = {
        {"metallicFactor", 0}, {"roughnessFactor", 0}, {"metallicRoughnessTexture", {{"index", 0}}}};
    extension("KHR_materials_transmission") = {{"transmissionFactor", 0},
                                               {"transmissionTexture", {{"index", 0}}}};
    extension("KHR_materials_clearcoat") = {{"clearcoatFactor", 0}, {"clearcoatTexture", {{"index", 0}}}};
    const Scene scene = load();
    EXPECT_EQ(top_material(scene).model, NEARLIGHT_BSDF_TWO_SIDED);  // and no blend with glass
    EXPECT_TRUE(scene.images.empty());
    const Material side = innermost(scene);
    for (const Parameter& parameter : {side.metallic, side.roughness, side.clearcoat}) {
        EXPECT_EQ(parameter.texture, -1);
        EXPECT_EQ(parameter.value.x, 0.0f);
    }
    extension("KHR_materials_transmission")["transmissionFactor"] = 1;
    EXPECT_EQ(top_material(load()).model, NEARLIGHT_BSDF_BLEND);
}

TEST_F(GltfLook, BaseTexturesAreMultipliedByVertexColours) {
    add_texel({1, 1, 1, 1});
    gltf_.material()["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}}};
    gltf_.primitive()["attributes"]["COLOR_0"] = gltf_.points({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
    const Scene scene = load();
    const auto texture = static_cast<std::size_t>(innermost(scene).reflectance.texture);
    EXPECT_EQ(scene.textures.at(texture).parameters.flags, NEARLIGHT_TEXTURE_TIMES_COLOR);
}

TEST_F(GltfLook, UnknownLooksAndFormatsAreNoted) {
    extension("KHR_materials_iridescence") = {{"iridescenceFactor", 1}};
    gltf_.root["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    gltf_.material()["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}}};
    const Scene scene = load();
    expect_note(scene, "KHR_materials_iridescence is left out");
    expect_note(scene, "KHR_texture_basisu is not supported");
}

}  // namespace
}  // namespace nearlight::core
