// SPDX-License-Identifier: Apache-2.0
#include "host/scene/texture_loader.h"

#include "host/image/color.h"
#include "host/scene/texture.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

class TextureLoaderTest : public testing::Test {
  protected:
    TextureLoaderTest() : notes_(scene_.notes, false), loader_(scene_, notes_) {}

    const TextureImage& add(const Image& image, const TexelRule& rule = {}) {
        return scene_.images[static_cast<std::size_t>(loader_.add(image, "image", rule, "file.xml", 3))];
    }

    Scene scene_;
    NoteSink notes_;
    TextureLoader loader_;
};

Image one_texel(std::vector<float> values) {
    constexpr const char* kNames[] = {"R", "G", "B", "A"};
    Image image{1, 1, {}, values};
    for (std::size_t i = 0; i < values.size(); ++i) {
        image.channels.emplace_back(kNames[i]);
    }
    return image;
}

TEST_F(TextureLoaderTest, EightBitsStayEightBits) {
    const TextureImage encoded = add(one_texel({1, 128 / 255.0f, 0}));
    EXPECT_EQ(encoded.format, NEARLIGHT_TEXELS_SRGB8);
    EXPECT_EQ(encoded.words, std::vector<std::uint32_t>{0xff0080ffu});
    const TextureImage linear = add(one_texel({1, 128 / 255.0f, 0}), {.gamma = 1.0f});
    EXPECT_EQ(linear.format, NEARLIGHT_TEXELS_LINEAR8);
    expect_near(texel_color(linear, 0), {1, 128 / 255.0f, 0});
}

TEST_F(TextureLoaderTest, MoreBitsBecomeHalves) {
    const TextureImage encoded = add(one_texel({0.5f, 0.25f, 0.125f}));
    EXPECT_EQ(encoded.format, NEARLIGHT_TEXELS_HALF);
    ASSERT_EQ(encoded.words.size(), 2u);
    expect_near(texel_color(encoded, 0),
                {srgb_to_linear(0.5f), srgb_to_linear(0.25f), srgb_to_linear(0.125f)}, 1e-4f);
    expect_near(texel_color(add(one_texel({0.5f, 0.25f, 3.0f}), {.gamma = 1.0f}), 0), {0.5f, 0.25f, 3});
    expect_near(texel_color(add(one_texel({0.5f, 1, 0}), {.gamma = 2.0f}), 0), {0.25f, 1, 0});
}

/// A TIFF file of one grey texel: a header, the entries of its directory, and the number behind them.
std::string tiff_of_float(float grey) {
    constexpr std::uint16_t kShort = 3;
    constexpr std::uint16_t kLong = 4;
    struct Entry {
        std::uint16_t tag, type;
        std::uint32_t count, value;
    };
    constexpr std::uint32_t kEnd = 8 + 2 + 10 * sizeof(Entry) + 4;
    const Entry entries[] = {
        {256, kShort, 1, 1}, {257, kShort, 1, 1}, {258, kShort, 1, 32},   // width, height, bits
        {259, kShort, 1, 1}, {262, kShort, 1, 1}, {273, kLong, 1, kEnd},  // plain, grey, where
        {277, kShort, 1, 1}, {278, kShort, 1, 1}, {279, kLong, 1, 4},     // channels, rows, bytes
        {339, kShort, 1, 3}};                                             // floats
    std::string text("II*\0\x08\0\0\0\x0a\0", 10);
    text.append(reinterpret_cast<const char*>(entries), sizeof(entries)).append(4, '\0');
    return text.append(reinterpret_cast<const char*>(&grey), sizeof(grey));
}

TEST_F(TextureLoaderTest, FilesOfFloatsAreLinear) {
    const SceneFiles files;
    const int image = loader_.load({.file = files.write("grey.tif", tiff_of_float(0.3f))}, {}, "file.xml", 3);
    ASSERT_EQ(image, 0);
    expect_near(texel_color(scene_.images[0], 0), {0.3f, 0.3f, 0.3f}, 1e-4f);
}

TEST_F(TextureLoaderTest, GreyImagesHaveThreeEqualChannels) {
    expect_near(texel_color(add(one_texel({1})), 0), {1, 1, 1});
    expect_near(texel_color(add(one_texel({1, 0})), 0), {1, 1, 1});  // the second channel is alpha
}

TEST_F(TextureLoaderTest, NumbersAreLuminances) {
    const TextureImage grey = add(one_texel({1, 1, 1}), {.is_number = true});
    EXPECT_EQ(grey.format, NEARLIGHT_TEXELS_SRGB8);
    const TextureImage number = add(one_texel({1, 0, 0}), {.is_number = true});
    expect_near(texel_color(number, 0), Vec3{1, 1, 1} * luminance(Vec3{1, 0, 0}), 1e-4f);
}

TEST_F(TextureLoaderTest, SingleChannels) {
    const Image image = one_texel({0, 51 / 255.0f, 1, 102 / 255.0f});
    expect_near(texel_color(add(image, {.channel = 1}), 0), {0.2f, 0.2f, 0.2f});
    expect_near(texel_color(add(image, {.channel = 3}), 0), {0.4f, 0.4f, 0.4f});
    expect_near(texel_color(add(one_texel({0, 0, 0}), {.channel = 3}), 0), {1, 1, 1});
    expect_near(texel_color(add(image, {.channel = 3, .is_inverse = true, .factor = 0.5f}), 0),
                {0.8f, 0.8f, 0.8f}, 1e-3f);
}

TEST_F(TextureLoaderTest, ChannelsOfColoursAreDecodedButAlphaIsLinear) {
    const Image image = one_texel({0, 51 / 255.0f, 1, 102 / 255.0f});
    const Vec3 green = Vec3{1, 1, 1} * srgb_to_linear(0.2f);
    expect_near(texel_color(add(image, {.channel = 1, .is_encoded = true}), 0), green);
    expect_near(texel_color(add(image, {.gamma = 2, .channel = 1, .is_encoded = true}), 0),
                {0.04f, 0.04f, 0.04f}, 1e-4f);
    expect_near(texel_color(add(image, {.gamma = 2, .channel = 3, .is_encoded = true}), 0),
                {0.4f, 0.4f, 0.4f});
}

TEST_F(TextureLoaderTest, AlphaMultipliesLinearColours) {
    const Image image = one_texel({1, 0.5f, 0, 0.25f});
    expect_near(texel_color(add(image, {.times_alpha = true}), 0), {0.25f, 0.25f * srgb_to_linear(0.5f), 0},
                1e-4f);
    expect_near(texel_color(add(image, {.times_alpha = true, .alpha_cutoff = 0.3f}), 0), {0, 0, 0});
    expect_near(texel_color(add(image, {.times_alpha = true, .alpha_cutoff = 0.2f}), 0),
                {1, srgb_to_linear(0.5f), 0}, 1e-3f);
}

TEST_F(TextureLoaderTest, MapsOfNormalsCanBeMadeSteeper) {
    const Image image = one_texel({0.75f, 0.25f, 1});
    expect_near(
        texel_color(add(image, {.gamma = 1, .is_signed = true, .steepness_x = 3, .steepness_y = -2}), 0),
        {1.25f, 1, 1}, 1e-3f);
}

TEST_F(TextureLoaderTest, SignedNumbersMayBeNegative) {
    expect_near(texel_color(add(one_texel({-0.5f, 0.25f, 1}), {.gamma = 1, .is_signed = true}), 0),
                {-0.5f, 0.25f, 1});
    EXPECT_TRUE(scene_.notes.empty());
    expect_near(texel_color(add(one_texel({-0.5f, 0.25f, 1}), {.gamma = 1}), 0), {0, 0.25f, 1});
    EXPECT_TRUE(has_note(scene_, "file.xml:3: 1 texels of 'image' are not finite"));
}

}  // namespace
}  // namespace nearlight::core
