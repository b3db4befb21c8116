// SPDX-License-Identifier: Apache-2.0
#include "host/image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/base/random.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image picture(int width, int height, std::vector<float> values,
              std::vector<std::string> channels = {"R", "G", "B"}) {
    return {width, height, std::move(channels), std::move(values)};
}

TEST(Metrics, HandComputedValues) {
    const Image a = picture(2, 1, {1, 2, 3, 0, 0, 0});
    const Image b = picture(2, 1, {1, 1, 1, 0, 0.1f, 0});
    const ImageDifference difference = compare_images(a, b);
    // The squared differences are 0, 1, 4, 0, 0.01 and 0.
    EXPECT_NEAR(difference.rmse, std::sqrt(5.01 / 6.0), 1e-6);
    EXPECT_NEAR(difference.relative_mse, (1.0 / 1.01 + 4.0 / 1.01 + 0.01 / 0.02) / 6.0, 1e-6);
    const double luminance_a = 0.2126 + 2 * 0.7152 + 3 * 0.0722;
    EXPECT_NEAR(difference.mean_ratio, luminance_a / (1.0 + 0.07152), 1e-6);
    EXPECT_EQ(difference.non_finite, 0u);
}

TEST(Metrics, SamePicturesDoNotDiffer) {
    Image image = make_image(31, 7, {"R", "G", "B"});
    Pcg32 random(3);
    for (float& value : image.values) {
        value = random.uniform();
    }
    const ImageDifference difference = compare_images(image, image);
    EXPECT_EQ(difference.rmse, 0.0);
    EXPECT_EQ(difference.relative_mse, 0.0);
    EXPECT_EQ(difference.mean_ratio, 1.0);
    EXPECT_EQ(difference.flip, 0.0);
}

TEST(Metrics, PicturesWithoutAFinitePixelAreNotAlike) {
    const Image image = picture(1, 1, {kNan, 1, 1});
    const ImageDifference difference = compare_images(image, image);
    EXPECT_TRUE(std::isnan(difference.rmse) && std::isnan(difference.relative_mse) &&
                std::isnan(difference.mean_ratio) && std::isnan(difference.flip));
    EXPECT_EQ(difference.non_finite, 1u);
}

TEST(Metrics, FlipSeesWhatAScreenShows) {
    const Image a = picture(1, 1, {2, 3, 2});
    const Image b = picture(1, 1, {3, 2, 2});
    EXPECT_EQ(compare_images(a, b).flip, 0.0) << "both are white";
    EXPECT_GT(compare_images(a, b, "", 0.25f).flip, 0.1);
    EXPECT_EQ(compare_images(a, b, "", 0.25f).rmse, compare_images(a, b).rmse);
    EXPECT_NE(flip_map(a, b, "", 0.25f).values, flip_map(a, b).values);
}

TEST(Metrics, AChannelIsALayer) {
    const Image a = picture(2, 1, {1, 0.5f}, {"A"});
    const Image b = picture(2, 1, {1, 0.25f}, {"A"});
    EXPECT_NEAR(compare_images(a, b, "A").rmse, 0.25 / std::sqrt(2.0), 1e-7);
}

TEST(Metrics, ChannelsAreFoundByName) {
    const std::vector<std::string> channels{"x.B", "R", "x.R", "G", "B", "x.G"};
    const Image a = picture(1, 1, {3, 9, 1, 9, 9, 2}, channels);
    const Image b = picture(1, 1, {1, 2, 3}, {"x.R", "x.G", "x.B"});
    EXPECT_EQ(compare_images(a, b, "x").rmse, 0.0);
    EXPECT_EQ(color_layers(a), (std::vector<std::string>{"", "x"}));
    EXPECT_EQ(color_layers(b), (std::vector<std::string>{"x"}));
    EXPECT_THROW(compare_images(a, b), Error);
    EXPECT_THROW(compare_images(a, b, "y"), Error);
}

TEST(Metrics, LayersThatAreNotColours) {
    const std::vector<std::string> channels{"depth.Z", "N.X", "N.Y", "N.Z"};
    const Image a = picture(2, 1, {3, 0, 0, 1, 1, 0, 1, 0}, channels);
    const Image b = picture(2, 1, {1, 0, 0, 1, 1, 0, 0, 1}, channels);
    const ImageDifference depth = compare_images(a, b, "depth");
    EXPECT_NEAR(depth.rmse, std::sqrt(4.0 / 2.0), 1e-6);
    EXPECT_NEAR(depth.mean_ratio, 2.0, 1e-6);
    EXPECT_TRUE(std::isnan(depth.flip));
    const ImageDifference normals = compare_images(a, b, "N");
    EXPECT_NEAR(normals.rmse, std::sqrt(2.0 / 6.0), 1e-6);
    EXPECT_TRUE(std::isnan(normals.mean_ratio));
    EXPECT_TRUE(std::isnan(normals.flip));
    EXPECT_THROW(flip_map(a, b, "N"), Error);
    const std::vector<std::string> of_two{"uv.U", "uv.V"};
    EXPECT_NEAR(compare_images(picture(1, 1, {3, 1}, of_two), picture(1, 1, {1, 1}, of_two), "uv").rmse,
                std::sqrt(4.0 / 2.0), 1e-6);
}

TEST(Metrics, LayersNeedAllThreeChannels) {
    EXPECT_TRUE(color_layers(picture(1, 1, {1, 2, 3, 4}, {"R", "G", "a.R", "Z"})).empty());
    EXPECT_EQ(color_layers(make_image(1, 1, {"a.b.R", "a.b.G", "a.b.B"})), (std::vector<std::string>{"a.b"}));
}

TEST(Metrics, PixelsThatAreNotFiniteAreCountedAndLeftOut) {
    const Image a = picture(3, 1, {kNan, 0, 0, 1, 1, 1, 0.5f, 0.5f, 0.5f});
    const Image b =
        picture(3, 1, {0, 0, 0, 1, std::numeric_limits<float>::infinity(), 1, 0.25f, 0.25f, 0.25f});
    const ImageDifference difference = compare_images(a, b);
    EXPECT_EQ(difference.non_finite, 2u);
    EXPECT_NEAR(difference.rmse, 0.25, 1e-7);
    EXPECT_NEAR(difference.mean_ratio, 2.0, 1e-6);
    EXPECT_TRUE(std::isfinite(difference.flip));
}

TEST(Metrics, BlackReference) {
    EXPECT_EQ(compare_images(picture(1, 1, {0, 0, 0}), picture(1, 1, {0, 0, 0})).mean_ratio, 1.0);
    EXPECT_TRUE(std::isinf(compare_images(picture(1, 1, {1, 0, 0}), picture(1, 1, {0, 0, 0})).mean_ratio));
}

TEST(Metrics, SizesMustAgree) {
    try {
        compare_images(make_image(2, 3, {"R", "G", "B"}), make_image(3, 2, {"R", "G", "B"}));
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::file);
    }
}

TEST(Metrics, FlipMapIsDarkWhereNothingDiffers) {
    Image a = make_image(64, 8, {"R", "G", "B"});
    const Image b = a;
    for (int y = 0; y < 8; ++y) {
        for (int x = 48; x < 64; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                a.at(x, y, c) = 1.0f;
            }
        }
    }
    const Image map = flip_map(a, b);
    EXPECT_EQ(map.width, 64);
    EXPECT_EQ(map.height, 8);
    EXPECT_LT(map.at(0, 4, 0), 0.01f);
    EXPECT_GT(map.at(63, 4, 0), 0.9f);
}

}  // namespace
}  // namespace nearlight::core
