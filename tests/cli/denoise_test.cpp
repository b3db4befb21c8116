// SPDX-License-Identifier: Apache-2.0
// `render --denoise` with a library that halves the light of the picture (tests/image/fake_oidn.cpp). Where
// pixels have one sample, nothing is known of their variance, so that nothing of their light is kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "host/image/image_io.h"
#include "host/image/rendered_share.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

std::string with_library(const std::string& name) {
    return std::string("NEARLIGHT_OIDN='") + NEARLIGHT_TEST_MODULES + "/" + name + ".so'";
}

class RenderDenoised : public testing::Test {
  protected:
    RenderDenoised() { std::ofstream(scene_) << floor_and_wall(); }

    [[nodiscard]] ProgramResult render(const std::string& options, const std::string& variables = "") const {
        return run_program("render --json --vpls 50 --spp 1 " + options + " " + quoted(scene_), variables);
    }
    [[nodiscard]] nlohmann::json rendered(const std::string& options,
                                          const std::string& variables = "") const {
        const ProgramResult result = render(options, variables);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output);
    }
    [[nodiscard]] std::string output(const std::string& name) const {
        return " -o " + quoted(folder_ / name);
    }
    /// What a file says of its denoising.
    [[nodiscard]] std::string denoised_by(const std::string& name) const {
        return std::get<std::string>(read_metadata(folder_ / name).at("nearlight:denoised"));
    }
    [[nodiscard]] Image picture(const std::string& name) const { return read_image(folder_ / name); }

    TemporaryFolder folder_;
    std::filesystem::path scene_ = folder_ / "scene.xml";
};

TEST_F(RenderDenoised, ChangesTheBeautyAndKeepsItAsALayer) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json plain = rendered(output("plain.exr"));
    const nlohmann::json json =
        rendered("--denoise" + output("a.exr") + output("a.png"), with_library("fake_oidn_2"));
    EXPECT_EQ(plain["denoiser"], "none");
    EXPECT_EQ(json["denoiser"], "Open Image Denoise 2.9.7 (direct and indirect apart, albedo, N)");
    EXPECT_EQ(json["image_hash"], plain["image_hash"]);
    EXPECT_GT(json["seconds"]["denoise"], 0.0);
    const Image raw = picture("plain.exr");
    const Image denoised = picture("a.exr");
    ASSERT_EQ(denoised.channel_count(), raw.channel_count() + 3);
    const auto raw_layer = static_cast<std::size_t>(denoised.find_channel("raw.R"));
    std::size_t wrong = 0;
    for (int y = 0; y < raw.height; ++y) {
        for (int x = 0; x < raw.width; ++x) {
            for (std::size_t c = 0; c < raw.channel_count(); ++c) {
                const bool is_beauty = c < 3;
                const bool is_broken = x + y == 0 && c == 0;  // the library gives a NaN there
                const float expected = is_broken ? 0.0f : raw.at(x, y, c) * (is_beauty ? 0.5f : 1.0f);
                // The beauty is a sum of two layers.
                const float tolerance = is_beauty ? 1e-6f * (1.0f + expected) : 0.0f;
                wrong += std::abs(denoised.at(x, y, c) - expected) <= tolerance ? 0 : 1;
                wrong += is_beauty && denoised.at(x, y, raw_layer + c) != raw.at(x, y, c) ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(denoised_by("plain.exr"), "none");
    EXPECT_EQ(denoised_by("a.exr"), json["denoiser"]);
    EXPECT_EQ(denoised_by("a.png"), json["denoiser"]);
}

/// What the mean of two passes keeps of its light, by their variance.
TEST_F(RenderDenoised, TheMeanOfPassesIsDenoisedOnceAndKeepsDetail) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json json =
        rendered("--denoise --passes 2 --layers raw,variance --exr-precision float --exposure auto" +
                     output("a.exr") + output("a.png"),
                 with_library("fake_oidn_2"));
    EXPECT_EQ(json["passes"], 2);
    EXPECT_EQ(json["denoiser"], "Open Image Denoise 2.9.7 (direct and indirect apart, albedo, N, variance)");
    EXPECT_EQ(denoised_by("a.exr"), json["denoiser"]);
    EXPECT_EQ(denoised_by("a.png"), json["denoiser"]);
    const Image image = picture("a.exr");
    const auto layer = [&](const std::string& first) {
        std::vector<float> values;
        const auto channel = static_cast<std::size_t>(image.find_channel(first));
        for (std::size_t i = channel; i < image.values.size(); i += image.channel_count()) {
            values.insert(values.end(), image.values.begin() + static_cast<std::ptrdiff_t>(i),
                          image.values.begin() + static_cast<std::ptrdiff_t>(i + 3));
        }
        return values;
    };
    const std::vector<float> raw = layer("raw.R");
    std::vector<float> halved = raw;
    std::ranges::for_each(halved, [](float& value) { value *= 0.5f; });
    halved[0] = 0.0f;  // where the library gives a NaN
    const std::vector<float> variance = layer("variance.R");
    const std::vector<float> shares = rendered_shares({image.width, image.height, raw, halved, variance});
    const std::vector<float> beauty = layer("R");
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) {
        const float expected = halved[i] + shares[i / 3] * (raw[i] - halved[i]);
        wrong += std::abs(beauty[i] - expected) <= 1e-4f * (1.0f + expected) ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(*std::ranges::min_element(shares), 0.0f);
    EXPECT_GT(*std::ranges::max_element(shares), 0.5f);
}

TEST_F(RenderDenoised, OnePixelIsEnough) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json json =
        rendered("--denoise --size 1x1" + output("a.exr"), with_library("fake_oidn_2"));
    EXPECT_EQ(json["denoiser"], "Open Image Denoise 2.9.7 (unchanged: less than 16 rows or columns)");
    EXPECT_EQ(denoised_by("a.exr"), json["denoiser"]);
    const Image image = picture("a.exr");
    EXPECT_EQ(image.width, 1);
    EXPECT_GT(image.at(0, 0, 1), 0.0f);
    EXPECT_NEAR(image.at(0, 0, 1), image.at(0, 0, static_cast<std::size_t>(image.find_channel("raw.G"))),
                1e-6f);
}

TEST_F(RenderDenoised, APreviewSaysThatItIsOne) {
    NEARLIGHT_NEEDS_DEVICE();
    const auto preview = [&](const std::string& options) {
        const ProgramResult result =
            run_program("render --json --preview " + options + " " + quoted(scene_) + output("a.exr"),
                        with_library("fake_oidn_2"));
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output);
    };
    const nlohmann::json json = preview("--denoise");
    EXPECT_EQ(json["preview"], true);
    EXPECT_EQ(json["samples_per_pixel"], 1);
    EXPECT_EQ(json["strata"], 16);
    EXPECT_EQ(json["denoiser"], "Open Image Denoise 2.9.7 (fast, albedo, N)");
    EXPECT_EQ(std::get<std::string>(read_metadata(folder_ / "a.exr").at("nearlight:preview")), "on");
    const nlohmann::json finer = preview("--spp 2 --vpls 60");
    EXPECT_EQ(finer["samples_per_pixel"], 2);
    EXPECT_EQ(finer["strata"], 32);
    EXPECT_EQ(finer["vpls"]["requested"], 60);
    EXPECT_EQ(finer["denoiser"], "none");
    EXPECT_EQ(rendered(output("a.exr"))["preview"], false);
}

TEST_F(RenderDenoised, WithoutTheLibraryNothingIsRendered) {
    const std::string missing = "NEARLIGHT_OIDN=/there/is/no/such/file.so";
    for (const std::string& library : {missing, with_library("fake_oidn_3")}) {
        const ProgramResult result = render("--denoise" + output("a.exr"), library);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_NE(result.errors.find("scripts/setup --denoise"), std::string::npos) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
    }
}

TEST_F(RenderDenoised, OnlyDenoisedPicturesHaveARawLayer) {
    const ProgramResult result = render("--layers raw" + output("a.exr"));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find("unknown layer 'raw'"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("; with --denoise also raw"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace nearlight::core
