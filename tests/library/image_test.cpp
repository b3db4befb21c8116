// SPDX-License-Identifier: Apache-2.0
#include "nearlight/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "nearlight/error.h"
#include "nearlight/tev.h"
#include "tests/support/tev_port.h"

namespace nearlight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// An image of two pixels with beauty and depth.
Image two_pixels() {
    return {.width = 2,
            .height = 1,
            .channels = {"R", "G", "B", "depth.Z"},
            .values = {0.0f, 0.25f, 1.0f, 3.5f, 0.5f, 2.0f, -1.0f, 7.0f}};
}

class ImageFiles : public testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

  private:
    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("nearlight-library-test-" + std::to_string(getpid()));
};

TEST(Layers, AreNamedInTheOrderOfTheirChannels) {
    EXPECT_THAT(layer_names(two_pixels()), ElementsAre("beauty", "depth"));
}

TEST(Layers, AlphaIsNoPartOfTheBeauty) {
    const Image image{.width = 1, .height = 1, .channels = {"R", "G", "B", "A"}, .values = {1, 2, 3, 0.5f}};
    EXPECT_THAT(layer_names(image), ElementsAre("beauty", "A"));
    EXPECT_THAT(layer(image, "beauty").values, ElementsAre(1, 2, 3));
    EXPECT_THAT(layer(image, "A").values, ElementsAre(0.5f));
}

TEST(Layers, AreCopiedWithoutTheirName) {
    const Image beauty = layer(two_pixels(), "beauty");
    EXPECT_THAT(beauty.channels, ElementsAre("R", "G", "B"));
    EXPECT_THAT(beauty.values, ElementsAre(0.0f, 0.25f, 1.0f, 0.5f, 2.0f, -1.0f));
    const Image depth = layer(two_pixels(), "depth");
    EXPECT_THAT(depth.channels, ElementsAre("Z"));
    EXPECT_EQ(depth.at(1, 0, 0), 7.0f);
}

TEST(Layers, WrongNamesAreTold) {
    try {
        layer(two_pixels(), "nosuch");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
        EXPECT_THAT(error.what(), HasSubstr("there are: beauty, depth"));
    }
}

TEST_F(ImageFiles, ExrKeepsEveryBit) {
    write_image(file("a.exr"), two_pixels());
    const Image read = read_image(file("a.exr"));
    EXPECT_EQ(read.width, 2);
    EXPECT_EQ(read.height, 1);
    EXPECT_EQ(read.channels, two_pixels().channels);
    EXPECT_EQ(read.values, two_pixels().values);
}

/// Values are doubled, then encoded with the sRGB curve of IEC 61966-2-1: 0.25 becomes 0.5, which is encoded
/// as 188 of 255.
TEST_F(ImageFiles, PngIsToneMapped) {
    write_image(file("a.png"), two_pixels(), {.exposure = 1.0f});
    const Image read = read_image(file("a.png"));
    ASSERT_THAT(read.channels, ElementsAre("R", "G", "B"));
    EXPECT_EQ(read.at(0, 0, 0), 0.0f);
    EXPECT_NEAR(read.at(0, 0, 1), std::round(255 * (1.055 * std::pow(0.5, 1 / 2.4) - 0.055)) / 255, 1e-6);
    EXPECT_EQ(read.at(0, 0, 2), 1.0f);
    EXPECT_EQ(read.at(1, 0, 1), 1.0f);
    EXPECT_EQ(read.at(1, 0, 2), 0.0f);
}

TEST_F(ImageFiles, PngIsReadLinear) {
    write_image(file("a.png"), two_pixels());
    const Image read = read_linear_image(file("a.png"));
    for (int x = 0; x < 2; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(read.at(x, 0, c), std::clamp(two_pixels().at(x, 0, c), 0.0f, 1.0f), 0.005f) << x << c;
        }
    }
    write_image(file("a.exr"), two_pixels());
    EXPECT_EQ(read_linear_image(file("a.exr")).values, two_pixels().values);
}

TEST_F(ImageFiles, PngHasAToneCurveAndCanHaveAnAutomaticExposure) {
    Image grey{.width = 1, .height = 1, .channels = {"R", "G", "B"}, .values = {0.5f, 0.5f, 0.5f}};
    write_image(file("a.png"), grey, {.tone_curve = ToneCurve::neutral});
    EXPECT_NEAR(read_image(file("a.png")).at(0, 0, 0), 1.055 * std::pow(0.46, 1 / 2.4) - 0.055, 0.003);
    EXPECT_NEAR(automatic_exposure(grey), std::log2(0.25f / 0.5f), 1e-4f);
    EXPECT_THROW(automatic_exposure(layer(two_pixels(), "depth")), Error);
}

TEST_F(ImageFiles, WhatCannotBeWrittenIsAnError) {
    const auto kind = [&](const std::string& name, const Image& image) {
        try {
            write_image(file(name), image);
        } catch (const Error& error) {
            return error.kind();
        }
        ADD_FAILURE() << name << " was written";
        return ErrorKind::failure;
    };
    EXPECT_EQ(kind("a.jpg", two_pixels()), ErrorKind::invalid_argument);
    EXPECT_EQ(kind("nosuch/a.exr", two_pixels()), ErrorKind::file);
    EXPECT_EQ(kind("a.png", layer(two_pixels(), "depth")), ErrorKind::file);
    Image cut = two_pixels();
    cut.values.pop_back();
    EXPECT_EQ(kind("a.exr", cut), ErrorKind::invalid_argument);
    EXPECT_THROW(read_image(file("a.exr")), Error);
}

TEST(TevLink, WhatCannotBeShownIsAnError) {
    core::test::TevPort port;
    TevLink link(port.address());
    const auto refusal = [&](const Image& image) -> std::string {
        try {
            link.show("room", image);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
            return error.what();
        }
        return "nothing was thrown";
    };
    Image narrow = two_pixels();
    narrow.width = 0;
    EXPECT_THAT(refusal(narrow), HasSubstr("cannot show 'room': an image needs at least one pixel"));
    Image nameless = two_pixels();
    nameless.channels.clear();
    EXPECT_THAT(refusal(nameless), HasSubstr("and one channel"));
    EXPECT_THAT(refusal({.width = 1, .height = -1, .channels = {"Y"}}), HasSubstr("at least one pixel"));
    Image cut = two_pixels();
    cut.values.pop_back();
    EXPECT_THAT(refusal(cut), HasSubstr("cannot show 'room': the image has 7 values"));
    EXPECT_NO_THROW(link.show("room", two_pixels()));
}

/// Half the light in one pixel of two: the mean falls by a sixth, since the other is twice as bright.
TEST(Differences, AreThoseOfTheLayer) {
    const Image reference{.width = 2,
                          .height = 1,
                          .channels = {"R", "G", "B", "a.R", "a.G", "a.B"},
                          .values = {1, 1, 1, 5, 5, 5, 2, 2, 2, 5, 5, 5}};
    Image image = reference;
    image.at(0, 0, 0) = image.at(0, 0, 1) = image.at(0, 0, 2) = 0.5f;
    const Difference difference = diff(image, reference);
    EXPECT_NEAR(difference.rmse, std::sqrt(0.25 / 2), 1e-6);
    EXPECT_NEAR(difference.relative_mse, 0.25 / 1.01 / 2, 1e-6);
    EXPECT_NEAR(difference.mean_ratio, 2.5 / 3, 1e-6);
    EXPECT_GT(difference.flip, 0.01);
    EXPECT_EQ(difference.non_finite, 0u);
    EXPECT_EQ(diff(image, reference, "a").rmse, 0.0);
    EXPECT_GT(diff_map(image, reference).at(0, 0, 0), diff_map(reference, reference).at(0, 0, 0));

    image.at(0, 0, 0) = NAN;
    EXPECT_EQ(diff(image, reference).non_finite, 1u);
    EXPECT_EQ(diff(image, reference).rmse, 0.0);
}

TEST(Differences, OfWhatCannotBeComparedAreErrors) {
    const auto text = [](const Image& a, const Image& b, const char* layer) -> std::string {
        try {
            diff(a, b, layer);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
            return error.what();
        }
        return "";
    };
    Image wide = two_pixels();
    wide.width = 1;
    EXPECT_THAT(text(two_pixels(), wide, "beauty"), HasSubstr("2x1 and 1x1"));
    EXPECT_THAT(text(two_pixels(), two_pixels(), "nosuch"), HasSubstr("nosuch"));
    EXPECT_THAT(text(two_pixels(), two_pixels(), "depth"), HasSubstr("R, G and B"));
    Image cut = two_pixels();
    cut.values.pop_back();
    EXPECT_THAT(text(cut, two_pixels(), "beauty"), HasSubstr("7 values"));
}

}  // namespace
}  // namespace nearlight
