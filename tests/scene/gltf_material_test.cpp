// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <iterator>
#include <numbers>

#include "host/image/image_io.h"
#include "tests/scene/gltf_text.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using namespace test;

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

}  // namespace
}  // namespace nearlight::core
