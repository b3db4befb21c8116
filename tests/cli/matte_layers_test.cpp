// SPDX-License-Identifier: Apache-2.0
// Mattes in files of the real program; tests/scripts/cryptomatte_test.py reads what they say.
#include "host/cli/matte_layers.h"

#include <gmock/gmock.h>

#include <bit>
#include <nlohmann/json.hpp>

#include "host/scene/scene_names.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;

constexpr const char* kLayers = " --layers cryptomatte_object,cryptomatte_material ";

class MatteLayers : public testing::Test {
  protected:
    MatteLayers() { std::ofstream(scene_) << floor_and_wall(); }
    [[nodiscard]] ProgramResult render(const std::string& options,
                                       const std::filesystem::path& output) const {
        return run_program("render --vpls 50 --spp 4 --filter gaussian " + options + " " + quoted(scene_) +
                           " -o " + quoted(output));
    }
    [[nodiscard]] static std::size_t attributes(const std::filesystem::path& file) {
        const Metadata metadata = read_metadata(file);
        return static_cast<std::size_t>(std::ranges::count_if(
            metadata, [](const auto& attribute) { return attribute.first.starts_with("cryptomatte/"); }));
    }

    TemporaryFolder folder_;
    std::filesystem::path scene_ = folder_ / "scene.xml";
    std::filesystem::path output_ = folder_ / "picture.exr";
};

TEST_F(MatteLayers, AreOnlyInExrFilesThatAskForThem) {
    NEARLIGHT_NEEDS_DEVICE();
    const std::filesystem::path screen = folder_ / "picture.png";
    ASSERT_EQ(render(kLayers + (" -o " + quoted(screen)), output_).exit_code, 0);
    EXPECT_EQ(attributes(output_), 8u);
    EXPECT_EQ(attributes(screen), 0u);
    EXPECT_EQ(read_image(output_).channels.size(), 3 + 2 * kMatteChannels);
    ASSERT_EQ(render("", output_).exit_code, 0);
    EXPECT_EQ(attributes(output_), 0u);
    EXPECT_EQ(read_image(output_).find_channel("CryptoObject00.R"), -1);
}

TEST(MatteAttributes, NamesInLatin1StayApart) {
    Scene scene;
    for (const char* name : {"B\xe4r", "B\xfcr"}) {
        begin_object(scene, name);
        scene.triangles.emplace_back();
    }
    Metadata metadata;
    add_matte_attributes(matte_layers(std::vector<std::string>{"cryptomatte_object"}), scene, metadata);
    for (const auto& [name, value] : metadata) {
        if (name.ends_with("manifest")) {
            const auto manifest = nlohmann::json::parse(std::get<std::string>(value));
            EXPECT_EQ(manifest.size(), 2u) << manifest;
            EXPECT_TRUE(manifest.contains("B\u00e4r")) << manifest;
        }
    }
    EXPECT_EQ(metadata.size(), 4u);
}

TEST_F(MatteLayers, SurviveNoLossyCompression) {
    const ProgramResult result = render(std::string(kLayers) + "--exr-compression dwaa", output_);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.errors, HasSubstr("cryptomatte_object would not survive the compression dwaa"));
}

TEST_F(MatteLayers, AreInTheHelpAndInTheReadme) {
    const std::string readme = file_text(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "README.md");
    const std::string help = run_program("render --help").output;
    for (const MatteLayer& layer : kMatteLayers) {
        EXPECT_THAT(readme, HasSubstr(layer.name));
        EXPECT_THAT(help, HasSubstr(layer.name));
    }
    EXPECT_THAT(run_program("merge --help").output, testing::Not(HasSubstr("cryptomatte")));
    const ProgramResult merge = run_program("merge --layers cryptomatte_object x.sums -o " + quoted(output_));
    EXPECT_EQ(merge.exit_code, 2);
    EXPECT_THAT(merge.errors, HasSubstr("unknown layer 'cryptomatte_object'"));
}

/// Mattes have samples of each pixel's own, and so has their picture unless the user wants splats.
TEST_F(MatteLayers, DecideWhetherThePictureHasSplats) {
    NEARLIGHT_NEEDS_DEVICE();
    const auto has_splats = [&](const std::string& options) {
        const ProgramResult result = render("--json " + options, output_);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output)["splat"].get<bool>();
    };
    EXPECT_TRUE(has_splats(""));
    EXPECT_FALSE(has_splats(kLayers));
    EXPECT_TRUE(has_splats(std::string("--splat on") + kLayers));
    EXPECT_FALSE(has_splats("--splat off"));
}

/// The samples of passes before a checkpoint count as well, and decide that the picture has splats.
TEST_F(MatteLayers, OfAResumedPictureAreThoseOfAnUninterruptedOne) {
    NEARLIGHT_NEEDS_DEVICE();
    const std::string checkpoint = " --checkpoint " + quoted(folder_ / "sums");
    ASSERT_EQ(render("--passes 1" + checkpoint, output_).exit_code, 0);
    ASSERT_EQ(render("--passes 3 --resume" + checkpoint + kLayers, output_).exit_code, 0);
    const std::filesystem::path whole_file = folder_ / "whole.exr";
    ASSERT_EQ(render(std::string("--passes 3 --splat on") + kLayers, whole_file).exit_code, 0);
    const Image resumed = read_image(output_);
    const Image whole = read_image(whole_file);
    ASSERT_EQ(resumed.channels, whole.channels);
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(resumed.values[i]),
                  std::bit_cast<std::uint32_t>(whole.values[i]))
            << whole.channels[i % whole.channel_count()];
    }
}

TEST(MatteAttributes, ListTheNamesOfSurfacesByTheConvention) {
    Scene scene;
    scene.triangles.resize(3);
    scene.objects = {{0, 0}, {2, 1}};
    scene.object_names = {"hello", "a \"quoted\" \xff name"};
    Metadata metadata{{"kept", 1}};
    add_matte_attributes(matte_layers(std::vector<std::string>{"depth", "cryptomatte_object"}), scene,
                         metadata);
    ASSERT_EQ(metadata.size(), 5u);
    const auto text = [&](const std::string& name) {
        return std::get<std::string>(metadata.at("cryptomatte/3ae39a5/" + name));
    };
    EXPECT_EQ(text("name"), "CryptoObject");
    EXPECT_EQ(text("hash"), "MurmurHash3_32");
    EXPECT_EQ(text("conversion"), "uint32_to_float32");
    EXPECT_THAT(text("manifest"), HasSubstr("\"hello\":\"248bfa47\""));
    EXPECT_THAT(text("manifest"), HasSubstr("\"a \\\"quoted\\\" \xef\xbf\xbd name\":"));
    EXPECT_EQ(without_matte_attributes(metadata), (Metadata{{"kept", 1}}));
}

}  // namespace
}  // namespace nearlight::core
