// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace nearlight::core {
namespace {

constexpr std::uint32_t kBlack = 0xff000000u;
constexpr std::uint32_t kWhite = 0xffffffffu;
constexpr std::uint32_t kRed = 0xff0000ffu;
constexpr std::uint32_t kBlue = 0xffff0000u;

void expect_texel(Vec3 a, Vec3 b, float tolerance = 1e-6f) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

/// A texture of 2 × 2 texels without scaling: black and white in the top row, red and blue in the bottom row.
Scene four_texels() {
    Scene scene;
    scene.images.push_back({"four", 2, 2, {kBlack, kWhite, kRed, kBlue}});
    SceneTexture texture;
    texture.parameters.kind = NEARLIGHT_TEXTURE_BITMAP;
    texture.parameters.u_scale = texture.parameters.v_scale = 1.0f;
    texture.image = 0;
    scene.textures.push_back(texture);
    return scene;
}

Vec3 four_texels_at(float u, float v) {
    const Scene scene = four_texels();
    return texture_color(scene, scene.textures[0], u, v);
}

TEST(Texture, SrgbDecodingMatchesTheStandard) {
    const auto& table = srgb_decode_table();
    EXPECT_EQ(table[0], 0.0f);
    EXPECT_EQ(table[255], 1.0f);
    EXPECT_NEAR(table[10], 10.0 / 255 / 12.92, 1e-9);
    EXPECT_NEAR(table[188], 0.5028865, 1e-6);  // the code of half the light
    expect_texel(decode_texel(0x00ff8000u), {0, table[128], 1});
}

TEST(Texture, TexelCentresGiveTheTexelAndVZeroIsTheBottom) {
    expect_texel(four_texels_at(0.25f, 0.25f), {1, 0, 0});
    expect_texel(four_texels_at(0.75f, 0.25f), {0, 0, 1});
    expect_texel(four_texels_at(0.25f, 0.75f), {0, 0, 0});
    expect_texel(four_texels_at(0.75f, 0.75f), {1, 1, 1});
}

TEST(Texture, BetweenCentresIsLinearInDecodedLight) {
    expect_texel(four_texels_at(0.5f, 0.75f), {0.5f, 0.5f, 0.5f});
    expect_texel(four_texels_at(0.375f, 0.25f), {0.75f, 0, 0.25f});
    expect_texel(four_texels_at(0.25f, 0.5f), {0.5f, 0, 0});
    expect_texel(four_texels_at(0.5f, 0.5f), {0.5f, 0.25f, 0.5f});
}

TEST(Texture, EdgesMixWithTheOppositeEdge) {
    for (const float edge : {0.0f, 1.0f, -3.0f, 7.0f}) {
        expect_texel(four_texels_at(edge, 0.75f), {0.5f, 0.5f, 0.5f});
        expect_texel(four_texels_at(0.75f, edge), {0.5f, 0.5f, 1});
    }
    expect_texel(four_texels_at(-1e-9f, 0.75f), {0.5f, 0.5f, 0.5f});
}

TEST(Texture, RepeatsInBothDirections) {
    for (const float shift : {-5.0f, -1.0f, 1.0f, 40.0f}) {
        expect_texel(four_texels_at(0.375f + shift, 0.25f), {0.75f, 0, 0.25f});
        expect_texel(four_texels_at(0.25f, 0.25f + shift), {1, 0, 0});
    }
}

TEST(Texture, HugeAndUnknownCoordinatesAreSafe) {
    for (const float u : {1e30f, -1e30f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
        const Vec3 color = four_texels_at(u, -u);
        EXPECT_TRUE(is_finite(color));
        EXPECT_GE(std::min({color.x, color.y, color.z}), 0.0f);
    }
    expect_texel(four_texels_at(std::nanf(""), 0.25f), four_texels_at(0.0f, 0.0f));  // 0·nan spoils t too
}

TEST(Texture, PlacementIsAffine) {
    Scene scene = four_texels();
    Texture& p = scene.textures[0].parameters;
    p.u_scale = 0.5f;
    p.u_shear = 0.25f;
    p.u_offset = 0.125f;
    p.v_shear = -1.0f;
    p.v_scale = 2.0f;
    p.v_offset = 0.375f;
    const float u = 0.3f;
    const float v = 0.9f;
    expect_texel(texture_color(scene, scene.textures[0], u, v),
                 four_texels_at(0.5f * u + 0.25f * v + 0.125f, -u + 2.0f * v + 0.375f));
}

TEST(Texture, OddSizes) {
    Scene scene = four_texels();
    scene.images[0] = {"column", 1, 3, {kWhite, kBlack, kRed}};
    const auto at = [&](float u, float v) { return texture_color(scene, scene.textures[0], u, v); };
    for (const float u : {0.0f, 0.2f, 0.5f, 0.99f}) {
        expect_texel(at(u, 0.5f / 3), {1, 0, 0});
        expect_texel(at(u, 1.5f / 3), {0, 0, 0});
        expect_texel(at(u, 2.5f / 3), {1, 1, 1});
        expect_texel(at(u, 0.0f), {1, 0.5f, 0.5f});
    }
}

TEST(Texture, CheckerboardColoursEqualHalvesAlike) {
    const Scene scene;
    SceneTexture texture;
    texture.parameters.kind = NEARLIGHT_TEXTURE_CHECKERBOARD;
    texture.parameters.u_scale = texture.parameters.v_scale = 1.0f;
    texture.parameters.color0 = {1, 0, 0};
    texture.parameters.color1 = {0, 1, 0};
    const auto at = [&](float u, float v) { return texture_color(scene, texture, u, v); };
    expect_texel(at(0.2f, 0.3f), {1, 0, 0});
    expect_texel(at(0.7f, 0.6f), {1, 0, 0});
    expect_texel(at(0.7f, 0.3f), {0, 1, 0});
    expect_texel(at(0.2f, 0.5f), {0, 1, 0});
    expect_texel(at(-0.2f, 3.2f), {0, 1, 0});
    expect_texel(at(-0.2f, -7.3f), {1, 0, 0});
    texture.parameters.u_scale = 2.0f;
    expect_texel(at(0.3f, 0.3f), {0, 1, 0});
}

}  // namespace
}  // namespace nearlight::core
