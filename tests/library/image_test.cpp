// SPDX-License-Identifier: Apache-2.0
#include "nearlight/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "nearlight/error.h"

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

}  // namespace
}  // namespace nearlight
