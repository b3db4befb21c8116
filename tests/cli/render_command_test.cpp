// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

#include "host/image/image_io.h"
#include "host/stages/film_layers.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

/// Whether the channel has a value other than zero.
bool has_content(const Image& image, const std::string& name) {
    const auto channel = static_cast<std::size_t>(image.find_channel(name));
    for (std::size_t i = channel; i < image.values.size(); i += image.channel_count()) {
        if (image.values[i] != 0.0f) {
            return true;
        }
    }
    return false;
}

/// --layers with every layer of the table.
std::string with_all_layers() {
    std::string option = "--layers ";
    for (const FilmLayer& layer : kFilmLayers) {
        option += (layer.is_beauty() ? "" : ",") + std::string(layer.name);
    }
    return option;
}

bool is_word_of(const std::string& text, const std::string& word) {
    return std::regex_search(text, std::regex("\\b" + word + "\\b"));
}

class Render : public testing::Test {
  protected:
    Render() {
        std::ofstream(scene_) << floor_and_wall(
            R"(<shape type="sphere"><point name="center" x="0.3" y="0" z="0.3"/><float name="radius" value="0.3"/>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.6, 0.6"/></bsdf></shape>)");
    }
    /// Renders to `output` with further options.
    [[nodiscard]] ProgramResult render(const std::string& options,
                                       const std::filesystem::path& output) const {
        return run_program("render --json --vpls 100 --spp 2 " + options + " " + quoted(scene_) + " -o " +
                           quoted(output));
    }
    [[nodiscard]] nlohmann::json rendered(const std::string& options,
                                          const std::filesystem::path& output) const {
        const ProgramResult result = render(options, output);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output);
    }

    TemporaryFolder folder_;
    std::filesystem::path scene_ = folder_ / "scene.xml";
    std::filesystem::path output_ = folder_ / "picture.exr";
};

TEST_F(Render, TakesNoMoreThreadsThanItMay) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json one = rendered("--threads 1", output_);
    const nlohmann::json plain = rendered("", output_);
    EXPECT_EQ(one["image_hash"], plain["image_hash"]);
    if (one["device"].at(0).get<std::string>().starts_with("pthread")) {  // a device of PoCL
        EXPECT_EQ(one["compute_units"], nlohmann::json::array({1}));
    }
    EXPECT_EQ(render("--threads -1", output_).exit_code, 2);
}

TEST_F(Render, SamplesShareTheVplsUnlessToldOtherwise) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json shared = rendered("", output_);
    EXPECT_EQ(shared["samples_per_pixel"], 2);
    EXPECT_EQ(shared["strata"], 2);
    EXPECT_EQ(rendered("--strata 2", output_)["image_hash"], shared["image_hash"]);
    const nlohmann::json whole = rendered("--strata 1", output_);
    EXPECT_EQ(whole["strata"], 1);
    EXPECT_EQ(whole["vpls"], shared["vpls"]);
    EXPECT_NE(whole["image_hash"], shared["image_hash"]);
    EXPECT_EQ(render("--strata 0", output_).exit_code, 2);
}

TEST_F(Render, PngHasTheExposureAndTheCurveThatWereAskedFor) {
    NEARLIGHT_NEEDS_DEVICE();
    const std::filesystem::path png = folder_ / "a.png";
    const auto brightness = [&](const std::string& options) {
        static_cast<void>(rendered(options, png));
        const Image image = read_linear_image(png);
        double sum = 0;
        for (const float value : image.values) {
            sum += static_cast<double>(value);
        }
        return sum / static_cast<double>(image.values.size());
    };
    const double plain = brightness("");
    EXPECT_EQ(std::get<std::string>(read_metadata(png).at("nearlight:tonemap")), "linear");
    EXPECT_EQ(std::get<std::string>(read_metadata(png).at("nearlight:exposure")), "+0.000");
    const double dark = brightness("--light-scale 1e-4");
    EXPECT_LT(dark, 0.01 * plain);
    EXPECT_GT(brightness("--light-scale 1e-4 --exposure auto --tonemap agx"), 0.1);
    EXPECT_EQ(std::get<std::string>(read_metadata(png).at("nearlight:tonemap")), "agx");
    EXPECT_LT(brightness("--exposure -3"), 0.5 * plain);
}

TEST_F(Render, WithoutAnOutputThePictureHasANameOfItsOwn) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = run_program("render --vpls 50 --spp 1 --size 16x12 " + quoted(scene_),
                                             "cd " + quoted(folder_ / ".") + " &&");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(std::filesystem::exists(folder_ / (scene_.stem().string() + "-render.png")));
}

TEST_F(Render, CutsHaveMoreVplsThanAPixelAsks) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json few = rendered("", output_);
    EXPECT_EQ(few["cuts"], false);
    EXPECT_EQ(few["vpls"]["set"], 100);
    EXPECT_EQ(rendered("--cuts off", output_)["image_hash"], few["image_hash"]);
    const nlohmann::json many = rendered("--vpl-set 3000", output_);
    EXPECT_EQ(many["cuts"], true);
    EXPECT_EQ(many["vpls"]["requested"], 100);
    EXPECT_EQ(many["vpls"]["set"], 3000);
    EXPECT_NEAR(many["vpls"]["close"].get<double>() + many["vpls"]["distant"].get<double>(), 3000, 300);
    EXPECT_NE(many["image_hash"], few["image_hash"]);
    const Metadata metadata = read_metadata(output_);
    EXPECT_EQ(metadata.at("nearlight:cuts"), Metadata::mapped_type{"on"});
    EXPECT_EQ(metadata.at("nearlight:vplsAsked"), Metadata::mapped_type{100});
    EXPECT_EQ(rendered("--cuts on", output_)["vpls"]["set"], 6400);
    const auto without_vpls = [&](const std::string& options) {
        return nlohmann::json::parse(run_program("render --json --vpls 0 --spp 2 " + options + " " +
                                                 quoted(scene_) + " -o " + quoted(output_))
                                         .output);
    };
    const nlohmann::json none = without_vpls("--vpl-set 3000");
    EXPECT_EQ(none["vpls"]["set"], 0);
    EXPECT_EQ(none["image_hash"], without_vpls("")["image_hash"]);
    for (const char* options : {"--vpl-set 3000 --cuts off", "--cuts on --roulette 1", "--cuts maybe",
                                "--vpl-set 3000 --sampler local", "--vpl-set 0", "--vpl-set 99",
                                "--cuts on --close-fraction 0.5", "--sampler local --roulette 1"}) {
        EXPECT_EQ(render(options, output_).exit_code, 2) << options;
    }
}

TEST_F(Render, BothTreesGiveTheSamePicture) {
    NEARLIGHT_NEEDS_DEVICE();
    EXPECT_EQ(rendered("--bvh fast", folder_ / "fast.exr")["bvh"], "fast");
    EXPECT_EQ(rendered("--bvh quality", folder_ / "quality.exr")["bvh"], "quality");
    EXPECT_EQ(rendered("", output_)["bvh"], "quality");
    const Image fast = read_image(folder_ / "fast.exr");
    const Image quality = read_image(folder_ / "quality.exr");
    ASSERT_EQ(fast.values.size(), quality.values.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < fast.values.size(); ++i) {
        different +=
            std::abs(fast.values[i] - quality.values[i]) > 1e-4f * std::abs(quality.values[i]) + 1e-6f;
    }
    // A ray through an edge that two triangles share may hit either of them.
    EXPECT_LE(different, fast.values.size() / 200);
}

TEST_F(Render, AnUnknownTreeIsAnsweredWithTheKnownOnes) {
    const ProgramResult result = render("--bvh slow", output_);
    EXPECT_EQ(result.exit_code, 2);
    for (const char* word : {"--bvh", "slow", "fast", "quality"}) {
        EXPECT_NE(result.errors.find(word), std::string::npos) << result.errors;
    }
    EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(Render, GlassIsInJsonAndInTheFile) {
    NEARLIGHT_NEEDS_DEVICE();
    EXPECT_EQ(rendered("", folder_ / "plain.exr")["glass"], "refract");
    EXPECT_EQ(rendered("--glass clear", output_)["glass"], "clear");
    EXPECT_EQ(read_metadata(folder_ / "plain.exr").at("nearlight:glass"), Metadata::mapped_type{"refract"});
    EXPECT_EQ(read_metadata(output_).at("nearlight:glass"), Metadata::mapped_type{"clear"});
    EXPECT_EQ(render("--glass red", output_).exit_code, 2);
}

TEST_F(Render, PassesAreCountedInJsonAndInTheFile) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json plain = rendered("", folder_ / "plain.exr");
    const nlohmann::json one = rendered("--passes 1", folder_ / "one.exr");
    EXPECT_EQ(plain["passes"], 1);
    EXPECT_EQ(one["image_hash"], plain["image_hash"]);
    const nlohmann::json three = rendered("--passes 3", output_);
    EXPECT_EQ(three["passes"], 3);
    EXPECT_EQ(three["vpls"]["requested"], 100);
    const auto gathered = [](const nlohmann::json& json) {
        return json["vpls"]["close"].get<double>() + json["vpls"]["distant"].get<double>();
    };
    EXPECT_NEAR(gathered(three), 3 * gathered(plain), 0.3 * gathered(plain));
    EXPECT_NE(three["image_hash"], plain["image_hash"]);
    const Metadata metadata = read_metadata(output_);
    EXPECT_EQ(metadata.at("nearlight:passes"), Metadata::mapped_type{3});
    EXPECT_EQ(metadata.at("nearlight:vpls"), Metadata::mapped_type{static_cast<int>(gathered(three))});
    // The same passes must give the same bits.
    EXPECT_EQ(rendered("--passes 3", output_)["image_hash"], three["image_hash"]);
}

TEST_F(Render, TimeEndsThePasses) {
    NEARLIGHT_NEEDS_DEVICE();
    EXPECT_EQ(rendered("--time 0", output_)["passes"], 1);
    EXPECT_EQ(rendered("--time 1000 --passes 2", output_)["passes"], 2);
}

TEST_F(Render, AnInterruptedOneSavesItsPasses) {
    NEARLIGHT_NEEDS_DEVICE();
    const auto passes = [](const ProgramResult& result) {
        return result.output.empty() ? 0 : nlohmann::json::parse(result.output)["passes"].get<int>();
    };
    const ProgramResult result =
        run_interrupted("render --json --passes 1000000 " + quoted(scene_) + " -o " + quoted(output_), 2,
                        [&](const ProgramResult& ended) { return passes(ended) > 1; });
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_EQ(nlohmann::json::parse(result.output)["interrupted"], true);
    const Image image = read_image(output_);
    EXPECT_EQ(read_metadata(output_).at("nearlight:passes"), Metadata::mapped_type{passes(result)});
    const auto green = static_cast<std::size_t>(image.find_channel("G"));
    EXPECT_GT(image.at(32, 24, green), 0.0f) << "the first pass is whole";
}

TEST_F(Render, RefusesPassesAndTimesThatAreNone) {
    for (const char* options : {"--passes 0", "--passes many", "--time -1", "--time soon"}) {
        EXPECT_EQ(render(options, output_).exit_code, 2) << options;
    }
}

TEST_F(Render, EveryLayerIsInTheFileInTheHelpAndInTheReadme) {
    NEARLIGHT_NEEDS_DEVICE();
    ASSERT_EQ(render(with_all_layers(), output_).exit_code, 0);
    const Image all = read_image(output_);
    EXPECT_TRUE(std::ranges::is_permutation(all.channels, layer_channels()));
    ASSERT_EQ(render("", folder_ / "plain.exr").exit_code, 0);
    EXPECT_EQ(read_image(folder_ / "plain.exr").find_channel("variance.R"), -1) << "it must be asked for";
    const std::string help = run_program("render --help").output;
    const std::string option =
        help.substr(help.find("--layers"), help.find("--exposure") - help.find("--layers"));
    const std::string readme = file_text(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "README.md");
    const std::string of_layers = readme.substr(readme.find("EXR files hold the layers"), 180);
    for (const FilmLayer& layer : kFilmLayers) {
        const std::string name(layer.name);
        for (std::size_t c = 0; c < layer.channel_count; ++c) {
            EXPECT_TRUE(has_content(all, channel_names(layer)[c])) << channel_names(layer)[c];
        }
        if (!layer.is_beauty()) {
            EXPECT_TRUE(is_word_of(option, name)) << help;
        }
        EXPECT_TRUE(is_word_of(of_layers, name)) << of_layers;
    }
}

TEST_F(Render, ExrFilesSayHowTheyWereMadeAndMayBePrecise) {
    NEARLIGHT_NEEDS_DEVICE();
    ASSERT_EQ(render("--layers A,depth", output_).exit_code, 0);
    const Image half = read_image(output_);
    const std::string line = std::get<std::string>(read_metadata(output_).at("nearlight:commandLine"));
    EXPECT_TRUE(line.starts_with("nearlight render --json")) << line;
    EXPECT_NE(line.find("--layers A,depth"), std::string::npos) << line;
    const std::filesystem::path precise = folder_ / "precise.exr";
    ASSERT_EQ(render("--layers A,depth --exr-precision float", precise).exit_code, 0);
    const Image full = read_image(precise);
    ASSERT_EQ(full.channels, half.channels);
    uint rounded = 0;
    for (std::size_t i = 0; i < full.values.size(); ++i) {
        const std::string& channel = full.channels[i % full.channel_count()];
        EXPECT_NEAR(half.values[i], full.values[i], std::abs(full.values[i]) / 2048 + 1e-7f);
        rounded += half.values[i] != full.values[i] ? 1 : 0;
        if (channel == "A") {
            const float depth = full.values[i - i % full.channel_count() +
                                            static_cast<std::size_t>(full.find_channel("depth.Z"))];
            EXPECT_EQ(full.values[i] > 0.0f, depth > 0.0f);
        }
    }
    EXPECT_GT(rounded, 0u);
    EXPECT_EQ(render("--exr-precision double", output_).exit_code, 2);
    EXPECT_EQ(render("--exr-compression rar", output_).exit_code, 2);
}

TEST_F(Render, APartHasThePixelsOfTheWhole) {
    NEARLIGHT_NEEDS_DEVICE();
    ASSERT_EQ(render("", output_).exit_code, 0);
    const Image whole = read_image(output_);
    const std::filesystem::path cropped = folder_ / "part.exr";
    const nlohmann::json json = rendered("--crop 20x10+30+15", cropped);
    EXPECT_EQ(json["width"], 20);
    EXPECT_EQ(json["height"], 10);
    const Image part = read_image(cropped);
    ASSERT_EQ(part.width, 20);
    ASSERT_EQ(part.height, 10);
    ASSERT_EQ(part.channels, whole.channels);
    for (int y = 0; y < part.height; ++y) {
        for (int x = 0; x < part.width; ++x) {
            for (std::size_t c = 0; c < part.channel_count(); ++c) {
                ASSERT_EQ(part.at(x, y, c), whole.at(30 + x, 15 + y, c)) << part.channels[c] << x << " " << y;
            }
        }
    }
    for (const char* window : {"20x10", "20x10+30", "20x10+-1+0", "0x10+0+0", "20x10+4000+0", "20x10+3+3+"}) {
        EXPECT_EQ(render("--crop " + std::string(window), cropped).exit_code, 2) << window;
    }
}

TEST_F(Render, LayersThatWereAskedForComeBesidesTheBeauty) {
    NEARLIGHT_NEEDS_DEVICE();
    ASSERT_EQ(render(with_all_layers(), output_).exit_code, 0);
    const Image all = read_image(output_);
    for (const FilmLayer& layer : kFilmLayers) {
        const std::filesystem::path file = folder_ / (std::string(layer.name) + ".exr");
        ASSERT_EQ(render("--layers " + std::string(layer.name), file).exit_code, 0);
        const Image some = read_image(file);
        std::vector<std::string> expected{"R", "G", "B"};
        if (!layer.is_beauty()) {
            std::ranges::copy(channel_names(layer), std::back_inserter(expected));
        }
        ASSERT_TRUE(std::ranges::is_permutation(some.channels, expected)) << layer.name;
        for (std::size_t c = 0; c < some.channel_count(); ++c) {
            const auto same = static_cast<std::size_t>(all.find_channel(some.channels[c]));
            EXPECT_EQ(some.at(20, 30, c), all.at(20, 30, same)) << some.channels[c];
        }
    }
}

}  // namespace
}  // namespace nearlight::core
