// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>

#include "host/base/half.h"
#include "host/scene/material_model.h"

namespace nearlight::core {
namespace {

constexpr std::uint32_t kBlack = 0xff000000u;
constexpr std::uint32_t kWhiteTexel = 0xffffffffu;
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
    scene.images.push_back({"four", 2, 2, NEARLIGHT_TEXELS_SRGB8, {kBlack, kWhiteTexel, kRed, kBlue}});
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
    scene.images[0] = {"column", 1, 3, NEARLIGHT_TEXELS_SRGB8, {kWhiteTexel, kBlack, kRed}};
    const auto at = [&](float u, float v) { return texture_color(scene, scene.textures[0], u, v); };
    for (const float u : {0.0f, 0.2f, 0.5f, 0.99f}) {
        expect_texel(at(u, 0.5f / 3), {1, 0, 0});
        expect_texel(at(u, 1.5f / 3), {0, 0, 0});
        expect_texel(at(u, 2.5f / 3), {1, 1, 1});
        expect_texel(at(u, 0.0f), {1, 0.5f, 0.5f});
    }
}

/// A checkerboard with one cell for each unit of u and v.
SceneTexture checkerboard(Parameter color0, Parameter color1) {
    SceneTexture texture;
    texture.parameters.kind = NEARLIGHT_TEXTURE_CHECKERBOARD;
    texture.parameters.u_scale = texture.parameters.v_scale = 1.0f;
    texture.parameters.color0 = color0;
    texture.parameters.color1 = color1;
    return texture;
}

TEST(Texture, CheckerboardColoursEqualHalvesAlike) {
    const Scene scene;
    SceneTexture texture = checkerboard(parameter_of(Vec3{1, 0, 0}), parameter_of(Vec3{0, 1, 0}));
    const auto at = [&](float u, float v) { return texture_color(scene, texture, u, v); };
    expect_texel(at(0.2f, 0.3f), {1, 0, 0});
    expect_texel(at(0.7f, 0.6f), {1, 0, 0});
    expect_texel(at(0.7f, 0.3f), {0, 1, 0});
    expect_texel(at(0.2f, 0.55f), {0, 1, 0});
    expect_texel(at(0.2f, 0.5f), {1, 0, 0});  // as in Mitsuba, the middle belongs to the first half
    expect_texel(at(-0.2f, 3.2f), {0, 1, 0});
    expect_texel(at(-0.2f, -7.3f), {1, 0, 0});
    texture.parameters.u_scale = 2.0f;
    expect_texel(at(0.3f, 0.3f), {0, 1, 0});
}

TEST(Texture, CheckerboardsOfTexturesAreLookedUpAtTheSurfacesCoordinates) {
    Scene scene = four_texels();
    scene.textures.push_back(checkerboard(textured(0, 0.5f), parameter_of(0.25f)));
    scene.textures.push_back(checkerboard(textured(1), {{1, 0, 0}, 0}));
    scene.textures[2].parameters.u_scale = 0.5f;
    const auto at = [&](float u, float v) { return parameter_value(scene, {{2, 2, 2}, 2}, u, v); };
    expect_texel(at(0.25f, 0.25f), {1, 0, 0});           // 2 · ½ · red
    expect_texel(at(0.75f, 0.25f), {0.5f, 0.5f, 0.5f});  // 2 · ¼
    expect_texel(at(1.25f, 0.25f), {2, 0, 0});           // 2 · red
}

TEST(Texture, ParametersScaleTexturesAndVertexColours) {
    Scene scene = four_texels();
    expect_texel(parameter_value(scene, parameter_of(Vec3{1, 2, 3}), 0, 0), {1, 2, 3});
    expect_texel(parameter_value(scene, {{1, 2, 3}, 0}, 0.75f, 0.75f), {1, 2, 3});
    SceneTexture texture;
    texture.parameters.kind = NEARLIGHT_TEXTURE_VERTEX_COLOR;
    scene.textures.push_back(texture);
    expect_texel(parameter_value(scene, textured(1, 2.0f), 0, 0, {0.1f, 0.2f, 0.3f}), {0.2f, 0.4f, 0.6f});
}

TEST(Texture, SecondCoordinatesVertexColoursAndCutoffs) {
    Scene scene = four_texels();
    const Vec3 first = texture_color(scene, scene.textures[0], 0.75f, 0.75f);
    const Vec3 second = texture_color(scene, scene.textures[0], 0.25f, 0.25f);
    ASSERT_FALSE(first == second);
    scene.textures[0].parameters.flags = NEARLIGHT_TEXTURE_SECOND_UV;
    expect_texel(texture_color(scene, scene.textures[0], 0.75f, 0.75f, kWhite, {0.25f, 0.25f}), second);
    scene.textures[0].parameters.flags = NEARLIGHT_TEXTURE_TIMES_COLOR;
    expect_texel(texture_color(scene, scene.textures[0], 0.75f, 0.75f, {0.5f, 0.25f, 1}),
                 first * Vec3{0.5f, 0.25f, 1});
    scene.textures[0].parameters.flags = 0;
    // Between the middles of a black and a white texel, at u = ¼ and ¾, numbers rise in proportion.
    for (const auto& [cutoff, edge] : {std::pair{0.2f, 0.35f}, {0.5f, 0.5f}, {0.9f, 0.7f}}) {
        scene.textures[0].parameters.cutoff = cutoff;
        for (const float u : {0.25f, edge - 0.01f, edge + 0.01f, 0.75f}) {
            SCOPED_TRACE(testing::Message() << cutoff << " at " << u);
            const float kept = u > edge ? 1.0f : 0.0f;
            EXPECT_EQ(texture_color(scene, scene.textures[0], u, 0.75f), (Vec3{kept, kept, kept}));
        }
    }
    scene.textures[0].parameters.cutoff = 1.5f;
    EXPECT_EQ(texture_color(scene, scene.textures[0], 0.75f, 0.75f), (Vec3{0, 0, 0}));
}

TEST(Texture, MeansOfTextures) {
    Scene scene = four_texels();
    scene.textures.push_back(checkerboard(textured(0), parameter_of(1.0f)));
    expect_texel(mean_value(scene, parameter_of(3.0f)), {3, 3, 3});
    expect_texel(mean_value(scene, textured(0, 2.0f)), {1, 0.5f, 1});
    expect_texel(mean_value(scene, textured(1)), {0.75f, 0.625f, 0.75f});
}

TEST(Texture, LeastAndLargestOfTextures) {
    Scene scene = four_texels();
    scene.images[0] = {"row", 2, 1, NEARLIGHT_TEXELS_LINEAR8, {0xff804020u, 0xff204080u}};
    scene.textures.push_back(checkerboard(textured(0), parameter_of(0.2f)));
    const float least = 0x20 / 255.0f, middle = 0x40 / 255.0f, largest = 0x80 / 255.0f;
    expect_texel(min_value(scene, parameter_of(3.0f)), {3, 3, 3});
    expect_texel(min_value(scene, textured(0, 2.0f)), {2 * least, 2 * middle, 2 * least});
    expect_texel(max_value(scene, textured(0, 2.0f)), {2 * largest, 2 * middle, 2 * largest});
    expect_texel(min_value(scene, textured(1)), {least, 0.2f, least});
    expect_texel(max_value(scene, textured(1)), {largest, middle, largest});
}

/// Three grey texels in a row, 0, ½ and 1, stored linear.
Scene grey_row(uint wrap, uint filter) {
    Scene scene = four_texels();
    scene.images[0] = {"row", 3, 1, NEARLIGHT_TEXELS_LINEAR8, {0xff000000u, 0xff808080u, 0xffffffffu}};
    scene.textures[0].parameters.wrap_s = scene.textures[0].parameters.wrap_t = wrap;
    scene.textures[0].parameters.filter = filter;
    return scene;
}

// Expected values from Mitsuba 3.9.1's `bitmap`, for the same three texels and coordinates.
TEST(Texture, WrapModesAndFilters) {
    const float us[] = {-0.9f, -0.2f, -0.1f, 0.05f, 0.5f, 0.95f, 1.1f, 1.2f, 1.95f, 2.3f};
    const struct {
        uint wrap, filter;
        float expected[10];
    } cases[] = {
        {NEARLIGHT_WRAP_REPEAT,
         NEARLIGHT_FILTER_BILINEAR,
         {0.200000f, 0.950196f, 0.800000f, 0.350000f, 0.501961f, 0.650000f, 0.200000f, 0.050196f, 0.650000f,
          0.200784f}},
        {NEARLIGHT_WRAP_REPEAT,
         NEARLIGHT_FILTER_NEAREST,
         {0.000000f, 1.000000f, 1.000000f, 0.000000f, 0.501961f, 1.000000f, 0.000000f, 0.000000f, 1.000000f,
          0.000000f}},
        {NEARLIGHT_WRAP_MIRROR,
         NEARLIGHT_FILTER_BILINEAR,
         {1.000000f, 0.050196f, 0.000000f, 0.000000f, 0.501961f, 1.000000f, 1.000000f, 0.950196f, 0.000000f,
          0.200784f}},
        {NEARLIGHT_WRAP_MIRROR,
         NEARLIGHT_FILTER_NEAREST,
         {1.000000f, 0.000000f, 0.000000f, 0.000000f, 0.501961f, 1.000000f, 1.000000f, 1.000000f, 0.000000f,
          0.000000f}},
        {NEARLIGHT_WRAP_CLAMP,
         NEARLIGHT_FILTER_BILINEAR,
         {0.000000f, 0.000000f, 0.000000f, 0.000000f, 0.501961f, 1.000000f, 1.000000f, 1.000000f, 1.000000f,
          1.000000f}},
        {NEARLIGHT_WRAP_CLAMP,
         NEARLIGHT_FILTER_NEAREST,
         {0.000000f, 0.000000f, 0.000000f, 0.000000f, 0.501961f, 1.000000f, 1.000000f, 1.000000f, 1.000000f,
          1.000000f}},
    };
    for (const auto& c : cases) {
        const Scene scene = grey_row(c.wrap, c.filter);
        for (std::size_t i = 0; i < std::size(us); ++i) {
            SCOPED_TRACE(us[i]);
            expect_texel(texture_color(scene, scene.textures[0], us[i], 0.5f), Vec3{1, 1, 1} * c.expected[i],
                         1e-5f);
        }
    }
}

TEST(Texture, HalfFloatsKeepWhatIsAboveOne) {
    Scene scene = four_texels();
    const auto word = [](float low, float high) {
        return float_to_half(low) | (static_cast<std::uint32_t>(float_to_half(high)) << 16u);
    };
    scene.images[0] = {"bright", 1, 1, NEARLIGHT_TEXELS_HALF, {word(12.5f, -0.25f), word(60000.0f, 1.0f)}};
    expect_texel(texture_color(scene, scene.textures[0], 0.3f, 0.3f), {12.5f, -0.25f, 60000.0f}, 0.01f);
}

}  // namespace
}  // namespace nearlight::core
