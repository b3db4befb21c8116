// SPDX-License-Identifier: Apache-2.0
#include "host/image/denoiser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "host/image/oidn_library.h"
#include "nearlight/error.h"
#include "tests/image/environment_variable.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string fake_library(const std::string& name) {
    return std::string(NEARLIGHT_TEST_MODULES) + "/" + name + ".so";
}

/// The message of the error that looking for a denoiser throws.
std::string refusal() {
    try {
        const Denoiser denoiser;
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::failure);
        return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

/// A grey picture in whose pixels five floats lie between the layers.
struct GreyPicture {
    static constexpr std::size_t kPixelFloats = 17;

    GreyPicture(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w * h) * kPixelFloats, 9.0f) {
        for (std::size_t i = 0; i < values.size(); i += kPixelFloats) {
            std::fill_n(values.begin() + i, 3, 0.5f);
            std::fill_n(values.begin() + i + 3, 3, 0.25f);
            std::fill_n(values.begin() + i + 6, 3, 1 / std::sqrt(3.0f));
        }
    }
    /// Denoises into the floats 9 to 11 of each pixel, whose variance are the floats 12 to 14 if it is known.
    void denoise(Denoiser& denoiser, bool knows_variance = false) {
        denoiser.denoise({.width = width,
                          .height = height,
                          .pixel_floats = kPixelFloats,
                          .light = {values.data()},
                          .albedo = values.data() + 3,
                          .normal = values.data() + 6,
                          .variance = knows_variance ? values.data() + 12 : nullptr,
                          .output = values.data() + 9});
    }
    [[nodiscard]] float& light(std::size_t pixel) { return values[pixel * kPixelFloats]; }
    [[nodiscard]] float& variance(std::size_t pixel) { return values[pixel * kPixelFloats + 12]; }
    [[nodiscard]] float output(std::size_t pixel) const { return values[pixel * kPixelFloats + 9]; }

    int width;
    int height;
    std::vector<float> values;
};

TEST(DenoiserTest, SaysWhatToDoWithoutTheLibrary) {
    const EnvironmentVariable file("NEARLIGHT_OIDN", "/there/is/no/such/file.so");
    const std::string message = refusal();
    EXPECT_NE(message.find("/there/is/no/such/file.so"), std::string::npos) << message;
    EXPECT_NE(message.find("scripts/setup --denoise"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(DenoiserTest, RefusesOtherVersions) {
    const EnvironmentVariable file("NEARLIGHT_OIDN", fake_library("fake_oidn_3"));
    EXPECT_NE(refusal().find("version 3.1.2"), std::string::npos) << refusal();
}

TEST(DenoiserTest, RefusesALibraryThatLacksAFunction) {
    const EnvironmentVariable file("NEARLIGHT_OIDN", fake_library("fake_oidn_1"));
    EXPECT_NE(refusal().find("lacks the function oidnGetDeviceInt"), std::string::npos) << refusal();
}

TEST(DenoiserTest, LooksInTheUsersFolder) {
    const EnvironmentVariable home("HOME", "/home/someone");
    {
        const EnvironmentVariable data("XDG_DATA_HOME", "/data");
        EXPECT_EQ(oidn_folder(), "/data/nearlight/oidn/lib");
    }
    const EnvironmentVariable data("XDG_DATA_HOME", "");
    EXPECT_EQ(oidn_folder(), "/home/someone/.local/share/nearlight/oidn/lib");
}

TEST(DenoiserTest, LoadsTheLibraryOfTheUsersFolder) {
    const EnvironmentVariable file("NEARLIGHT_OIDN", "");
    const TemporaryFolder folder;
    const EnvironmentVariable data("XDG_DATA_HOME", folder.path().string());
    std::filesystem::create_directories(oidn_folder());
    std::filesystem::copy(fake_library("fake_oidn_2"), oidn_folder() / "libOpenImageDenoise.so.2");
    const std::string name = Denoiser().name();
    if (name != "Open Image Denoise 2.9.7") {
        GTEST_SKIP() << "the system has " << name;
    }
}

TEST(DenoiserTest, GivesTheLibraryFiniteLightAndKeepsOtherValues) {
    const EnvironmentVariable file("NEARLIGHT_OIDN", fake_library("fake_oidn_2"));
    Denoiser denoiser;
    GreyPicture picture(20, 16);
    picture.light(1) = NAN;
    picture.light(2) = kInfinity;
    picture.light(3) = -1.0f;
    const std::vector<float> before = picture.values;
    picture.denoise(denoiser);
    for (std::size_t i = 0; i < 320; ++i) {
        EXPECT_EQ(picture.output(i), i < 4 ? 0.0f : 0.25f) << i;
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
        const std::size_t place = i % GreyPicture::kPixelFloats;
        if (place < 9 || place > 11) {
            EXPECT_TRUE(picture.values[i] == before[i] || std::isnan(before[i])) << i;
        }
    }
}

/// In a picture of two halves, one without noise and one whose noise is as large as what the library changes.
TEST(DenoiserTest, KeepsWhatNoiseDoesNotExplain) {
    const EnvironmentVariable file("NEARLIGHT_OIDN", fake_library("fake_oidn_2"));
    Denoiser denoiser;
    GreyPicture picture(40, 16);
    for (std::size_t i = 0; i < 640; ++i) {
        std::fill_n(&picture.variance(i), 3, i % 40 < 20 ? 0.0f : 0.25f * 0.25f);
    }
    picture.variance(5) = NAN;
    picture.denoise(denoiser, true);
    for (std::size_t i = 40 * 8; i < 640; ++i) {
        const std::size_t x = i % 40;
        if (x < 17 || x > 22) {
            EXPECT_EQ(picture.output(i), x < 20 ? 0.5f : 0.25f) << i;
        }
    }
    EXPECT_EQ(picture.output(2 * 40 + 5), 0.25f) << "nothing is known of a neighbour";
    picture.denoise(denoiser);
    EXPECT_EQ(picture.output(40 * 8), 0.25f) << "without a variance, nothing is kept";
}

/// The tests below need the real library, and are skipped where it is not installed.
class RealDenoiser : public testing::Test {
  protected:
    void SetUp() override {
        try {
            denoiser_.emplace();
        } catch (const Error& error) {
            GTEST_SKIP() << error.what();
        }
    }

    std::optional<Denoiser> denoiser_;
};

TEST_F(RealDenoiser, TakesNoiseAway) {
    GreyPicture picture(96, 64);
    std::mt19937 random(1);
    std::exponential_distribution<float> noise(2.0f);  // of mean 0.5
    double before = 0;
    for (std::size_t i = 0; i < 96 * 64; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            (&picture.light(i))[c] = noise(random);
        }
        before += std::pow(picture.light(i) - 0.5, 2);
    }
    picture.denoise(*denoiser_);
    double after = 0;
    for (std::size_t i = 0; i < 96 * 64; ++i) {
        after += std::pow(picture.output(i) - 0.5, 2);
    }
    EXPECT_LT(after, 0.05 * before);
}

TEST_F(RealDenoiser, TakesPicturesOfOnePixelAndBrokenOnes) {
    for (const int size : {1, 2, 16, 17}) {
        GreyPicture picture(size, size);
        picture.light(0) = NAN;
        picture.light(static_cast<std::size_t>(size) - 1) = size == 1 ? NAN : kInfinity;
        picture.denoise(*denoiser_);
        for (int i = 0; i < size * size; ++i) {
            EXPECT_TRUE(std::isfinite(picture.output(static_cast<std::size_t>(i)))) << size << " " << i;
        }
    }
    GreyPicture plain(1, 1);
    plain.denoise(*denoiser_);
    EXPECT_EQ(plain.output(0), 0.5f);
}

}  // namespace
}  // namespace nearlight::core
