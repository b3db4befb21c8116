// SPDX-License-Identifier: Apache-2.0
#include "host/compare/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/base/random.h"
#include "host/compare/picture_error.h"
#include "host/image/metrics.h"

namespace nearlight::core {
namespace {

Image random_picture(int width, int height, std::uint64_t seed) {
    Pcg32 random(seed);
    Image picture = make_picture(width, height);
    for (float& value : picture.values) {
        value = random.uniform();
    }
    return picture;
}

Reference reference_of(const Image& picture) {
    return {.picture = picture, .method = "path tracing", .samples = 1};
}

TEST(Pictures, ShrinkToMeans) {
    Image picture = make_picture(5, 4);
    picture.at(0, 0, 1) = 1.0f;
    picture.at(1, 1, 1) = 3.0f;
    picture.at(3, 3, 2) = 8.0f;
    const Image small = shrunk(picture, 3);
    EXPECT_EQ(small.width, 2);
    EXPECT_EQ(small.height, 2);
    EXPECT_EQ(small.at(0, 0, 1), 1.0f);
    EXPECT_EQ(small.at(1, 1, 2), 2.0f);
    EXPECT_EQ(shrunk(picture, 5).width, 5);
}

TEST(Pictures, CropAndEnlargeKeepPixels) {
    const Image picture = random_picture(7, 5, 1);
    const Image part = cropped(picture, {2, 1, 3, 4});
    EXPECT_EQ(part.at(1, 2, 0), picture.at(3, 3, 0));
    EXPECT_EQ(enlarged(part, 3).at(8, 11, 2), picture.at(4, 4, 2));
}

TEST(Pictures, ScaleMakesBrightPartsBright) {
    Image picture = make_picture(100, 1);
    for (int x = 0; x < 100; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
            picture.at(x, 0, c) = x < 97 ? 0.01f : 500.0f;
        }
    }
    EXPECT_NEAR(display_scale(picture), 70.0f, 0.01f);  // the few pixels of lamps have no effect
    EXPECT_EQ(display_scale(make_picture(3, 3)), 1.0f);
}

TEST(Pictures, ErrorMapTellsMissingFromTooMuch) {
    Image reference = make_picture(3, 1);
    std::fill(reference.values.begin(), reference.values.end(), 1.0f);
    Image picture = reference;
    for (std::size_t c = 0; c < 3; ++c) {
        picture.at(0, 0, c) = 0.0f;
        picture.at(2, 0, c) = 2.0f;
    }
    const Image map = signed_error_map(picture, reference);
    EXPECT_GT(map.at(0, 0, 2), 2 * map.at(0, 0, 0));
    EXPECT_GT(map.at(1, 0, 0), 0.9f);
    EXPECT_GT(map.at(1, 0, 2), 0.9f);
    EXPECT_GT(map.at(2, 0, 0), 2 * map.at(2, 0, 2));
}

TEST(Pictures, CropsAreWhereErrorsAreAndApart) {
    const Image reference = make_picture(40, 20);
    Image picture = reference;
    picture.at(35, 17, 0) = 9.0f;
    picture.at(4, 3, 0) = 5.0f;
    const std::vector<Crop> crops = hardest_crops(picture, reference, 2);
    ASSERT_EQ(crops.size(), 2u);
    const auto holds = [](const Crop& c, int x, int y) {
        return x >= c.x && x < c.x + c.width && y >= c.y && y < c.y + c.height;
    };
    EXPECT_TRUE(holds(crops[0], 35, 17));
    EXPECT_TRUE(holds(crops[1], 4, 3));
    EXPECT_EQ(crops[0].width, 10);
    EXPECT_EQ(crops[0].height, 5);
    EXPECT_EQ(hardest_crops(make_picture(1, 1), make_picture(1, 1), 2).size(), 1u);
}

TEST(PictureError, IsThatOfDiff) {
    const Image picture = random_picture(16, 12, 1);
    const Reference reference = reference_of(random_picture(16, 12, 2));
    const PictureError error = picture_error(picture, reference);
    const ImageDifference difference = compare_images(picture, reference.picture);
    EXPECT_NEAR(std::sqrt(error.squared_error), difference.rmse, 1e-12);
    EXPECT_NEAR(error.relative_mse, difference.relative_mse, 1e-9);
    EXPECT_NEAR(error.mean_ratio, difference.mean_ratio, 1e-12);
    EXPECT_NEAR(error.flip, difference.flip, 1e-9);
    EXPECT_NEAR(rmse_of_part(picture, reference.picture, {0, 0, 16, 12}), difference.rmse, 1e-12);
}

TEST(PictureError, TheNoiseOfTheReferenceIsTakenOff) {
    // The picture is right. The reference is wrong by ±0.1, and its variance says so.
    Reference reference = reference_of(random_picture(64, 64, 3));
    const Image picture = reference.picture;
    for (std::size_t i = 0; i < reference.picture.values.size(); ++i) {
        reference.picture.values[i] += i % 2 == 0 ? 0.1f : -0.1f;
    }
    EXPECT_NEAR(picture_error(picture, reference).squared_error, 0.01, 1e-6);
    reference.noise = {.known = true, .mean_variance = 0.01, .mean_relative_variance = 0.0};
    EXPECT_NEAR(picture_error(picture, reference).squared_error, 0.0, 1e-6);
}

TEST(PictureError, MeanErrorHasASignForEachColor) {
    const Reference reference = reference_of(random_picture(8, 8, 4));
    Image picture = reference.picture;
    for (std::size_t i = 0; i < picture.values.size(); i += 3) {
        picture.values[i] += 0.5f;
        picture.values[i + 2] -= 0.25f;
    }
    const PictureError error = picture_error(picture, reference);
    EXPECT_NEAR(error.mean_error[0], 0.5, 1e-6);
    EXPECT_NEAR(error.mean_error[1], 0.0, 1e-6);
    EXPECT_NEAR(error.mean_error[2], -0.25, 1e-6);
}

TEST(PictureError, PixelsThatAreNoNumbersAreCountedAndLeftOut) {
    const Reference reference = reference_of(random_picture(8, 8, 5));
    Image picture = reference.picture;
    picture.values[4] = std::numeric_limits<float>::quiet_NaN();
    picture.values[30] = std::numeric_limits<float>::infinity();
    const PictureError error = picture_error(picture, reference);
    EXPECT_EQ(error.non_finite, 2u);
    EXPECT_EQ(error.squared_error, 0.0);
    EXPECT_TRUE(std::isfinite(error.flip));
}

}  // namespace
}  // namespace nearlight::core
