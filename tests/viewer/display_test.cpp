// SPDX-License-Identifier: Apache-2.0
#include "viewer/display.h"

#include <gtest/gtest.h>

#include <limits>

#include "nearlight/session.h"

namespace nearlight::viewer {
namespace {

/// A picture of one pixel with all layers, whose channels are 0 but for those of `values`.
Image pixel(const std::vector<std::pair<std::string, float>>& values) {
    Image image{.width = 1, .height = 1, .channels = picture_channels()};
    image.values.resize(image.channels.size());
    for (const auto& [channel, value] : values) {
        for (std::size_t i = 0; i < image.channels.size(); ++i) {
            image.values[i] = image.channels[i] == channel ? value : image.values[i];
        }
    }
    return image;
}

std::size_t layer(std::string_view name) {
    std::size_t index = 0;
    while (shown_layers()[index].name != name) {
        ++index;
    }
    return index;
}

std::array<int, 4> shown(const Image& image, const DisplaySettings& settings) {
    const ScreenPixels screen = to_screen(image, settings);
    EXPECT_EQ(screen.rgba.size(), 4u);
    return {screen.rgba[0], screen.rgba[1], screen.rgba[2], screen.rgba[3]};
}

/// 0.5 is 188 of 255 by the curve of IEC 61966-2-1.
TEST(Display, LightPassesExposureAndCurve) {
    const Image image = pixel({{"R", 0.25f}, {"G", 3.0f}, {"B", std::numeric_limits<float>::quiet_NaN()}});
    EXPECT_EQ(shown(image, {.exposure = 1.0f}), (std::array{188, 255, 0, 255}));
    EXPECT_EQ(shown(pixel({{"direct.G", 0.5f}}), {.layer = layer("direct")}), (std::array{0, 188, 0, 255}));
}

TEST(Display, AlbedoHasNoExposure) {
    EXPECT_EQ(shown(pixel({{"albedo.B", 0.5f}}), {.layer = layer("albedo"), .exposure = 5.0f}),
              (std::array{0, 0, 188, 255}));
}

TEST(Display, NormalsAreShownFromMinusOneToOne) {
    EXPECT_EQ(shown(pixel({{"N.X", -1.0f}, {"N.Z", 1.0f}}), {.layer = layer("N")}),
              (std::array{0, 128, 255, 255}));
}

TEST(Display, NearIsWhiteAndNothingIsBlack) {
    Image image = pixel({{"depth.Z", 2.0f}});
    const Image far = pixel({{"depth.Z", 4.0f}});
    const Image nothing = pixel({});
    image.width = 3;
    image.values.insert(image.values.end(), far.values.begin(), far.values.end());
    image.values.insert(image.values.end(), nothing.values.begin(), nothing.values.end());
    const ScreenPixels screen = to_screen(image, {.layer = layer("depth")});
    EXPECT_EQ(screen.rgba[0], 255);
    EXPECT_LT(screen.rgba[4], 60);
    EXPECT_GT(screen.rgba[4], 0);
    EXPECT_EQ(screen.rgba[8], 0);
}

TEST(Display, TheCloseRangeIsTinted) {
    const auto plain = shown(pixel({}), {.show_close_range = true});
    const auto tinted = shown(pixel({{"closerange.Y", 1.0f}}), {.show_close_range = true});
    EXPECT_EQ(plain, (std::array{0, 0, 0, 255}));
    EXPECT_GT(tinted[2], 50);
}

/// The menu has every layer that files get unless others are asked for.
TEST(Display, TheMenuHasTheLayersOfPictures) {
    Image image{.width = 0, .height = 0, .channels = picture_channels()};
    std::vector<std::string> names = layer_names(image);
    std::erase(names, "variance");
    std::erase(names, "A");
    ASSERT_EQ(names.size(), shown_layers().size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(names[i], shown_layers()[i].name);
    }
}

}  // namespace
}  // namespace nearlight::viewer
