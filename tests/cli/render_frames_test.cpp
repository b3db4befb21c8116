// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/image/image_io.h"
#include "tests/cli/animated_room.h"
#include "tests/cli/run_program.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using testing::Not;

class Frames : public testing::Test {
  protected:
    Frames() {
        const AnimatedRoom room = animated_room();
        std::ofstream(scene_) << room.json;
        std::ofstream(folder_ / "room.bin", std::ios::binary) << room.buffer;
    }
    [[nodiscard]] ProgramResult render(const std::string& options, const std::string& output) const {
        return run_program("render --json --size 24x16 --vpls 60 --spp 2 --rays 2 --direct-samples 4 " +
                           options + " " + quoted(scene_) + " -o " + quoted(folder_ / output));
    }
    [[nodiscard]] nlohmann::json rendered(const std::string& options, const std::string& output = "a.exr") {
        const ProgramResult result = render(options, output);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output);
    }
    [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

    TemporaryFolder folder_;
    std::filesystem::path scene_ = folder_ / "room.gltf";
};

/// The hashes of all pictures, in order.
std::vector<std::string> hashes(const nlohmann::json& json) {
    std::vector<std::string> all;
    for (const nlohmann::json& frame : json["frames"]) {
        all.push_back(frame["image_hash"]);
    }
    return all;
}

TEST_F(Frames, HaveNumbersAndShowTheirMoments) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json json = rendered("--frames 0:2 --fps 2", "walk.##.exr");
    ASSERT_EQ(json["frames"].size(), 3u);
    EXPECT_EQ(json["interrupted"], false);
    for (int frame = 0; frame < 3; ++frame) {
        const std::string name = "walk.0" + std::to_string(frame) + ".exr";
        ASSERT_TRUE(has(name));
        const Metadata metadata = read_metadata(folder_ / name);
        EXPECT_EQ(std::get<int>(metadata.at("nearlight:frame")), frame);
        // A pixel beside the middle of the picture shows the wall straight before the camera.
        const Image image = read_image(folder_ / name);
        const std::size_t middle = (8 * 24 + 12) * image.channel_count();
        const auto x = static_cast<std::size_t>(image.find_channel("P.X"));
        EXPECT_NEAR(image.values.at(middle + x), -0.5 + 0.5 * frame, 0.2);
    }
    EXPECT_FALSE(has("walk.03.exr"));
    EXPECT_NE(hashes(json)[0], hashes(json)[1]);
}

TEST_F(Frames, AreTheSameBitsAloneAndTogether) {
    NEARLIGHT_NEEDS_DEVICE();
    // Up to frame 6 only the camera moves; then the lamp rises too, and at 8 all is still.
    const std::string options = "--fps 4 --vpl-keys 3 --frames ";
    const nlohmann::json together = rendered(options + "2:9");
    const std::vector<std::string> keys{
        "0:0.3333 3:0.6667", "3:1", "3:0.6667 6:0.3333", "3:0.3333 6:0.6667", "6:1", "", "9:1", "9:1"};
    for (std::size_t i = 0; i < keys.size(); ++i) {
        EXPECT_EQ(together["frames"][i]["vpl_keys"], keys[i]) << "frame " << i + 2;
    }
    for (const int frame : {4, 7, 8}) {
        const nlohmann::json alone = rendered(options + std::to_string(frame), "b.exr");
        EXPECT_EQ(hashes(alone).at(0), hashes(together).at(static_cast<std::size_t>(frame - 2)));
    }
    EXPECT_EQ(hashes(together)[6], hashes(together)[7]) << "nothing moves";
}

TEST_F(Frames, OfSeveralPassesAreTheSameBitsToo) {
    NEARLIGHT_NEEDS_DEVICE();
    const std::string options = "--fps 4 --passes 2 --frames ";
    const nlohmann::json together = rendered(options + "1:2");
    EXPECT_EQ(together["frames"][1]["passes"], 2);
    EXPECT_EQ(hashes(rendered(options + "2", "b.exr")).at(0), hashes(together)[1]);
}

TEST_F(Frames, AtAKeyViewAreThePictureWithVplsOfItsOwn) {
    NEARLIGHT_NEEDS_DEVICE();
    const auto kept = hashes(rendered("--frames 2:3 --fps 4 --vpl-keys 2"));
    const auto fresh = hashes(rendered("--frames 2:3 --fps 4 --vpl-keys 0"));
    EXPECT_EQ(kept[0], fresh[0]);
    EXPECT_NE(kept[1], fresh[1]);
}

TEST_F(Frames, TakeTheOtherOptionsOfPictures) {
    NEARLIGHT_NEEDS_DEVICE();
    const nlohmann::json json =
        rendered("--frames 1:2 --fps 4 --crop 8x4+3+2 --layers albedo,cryptomatte_object --animation walk");
    EXPECT_EQ(json["frames"][0]["width"], 8);
    EXPECT_GE(read_image(folder_ / "a.0002.exr").find_channel("albedo.R"), 0);
    EXPECT_GE(read_image(folder_ / "a.0002.exr").find_channel("CryptoObject00.R"), 0);
    // The lamp stays where it is.
    EXPECT_EQ(hashes(rendered("--frames 8 --fps 4 --animation 1"))[0],
              hashes(rendered("--frames 5 --fps 4 --animation 1"))[0]);
}

TEST_F(Frames, OfVplsFromAFileNeedTheirLight) {
    NEARLIGHT_NEEDS_DEVICE();
    ASSERT_EQ(run_program("render --vpls 60 --size 24x16 --spp 1 --save-vpls " + quoted(folder_ / "v.ply") +
                          " " + quoted(scene_) + " -o " + quoted(folder_ / "still.exr"))
                  .exit_code,
              0);
    const std::string load = "--fps 4 --spp 1 --load-vpls " + quoted(folder_ / "v.ply") + " --frames ";
    const std::string before = "render --json --size 24x16 " + load;
    const std::string after = " " + quoted(scene_) + " -o " + quoted(folder_ / "l.exr");
    const ProgramResult good = run_program(before + "1:2" + after);
    EXPECT_EQ(good.exit_code, 0) << good.errors;
    EXPECT_EQ(nlohmann::json::parse(good.output)["frames"][0]["sampler"], "file");
    const ProgramResult bad = run_program(before + "6:8" + after);
    EXPECT_EQ(bad.exit_code, 3) << bad.errors;
    EXPECT_THAT(bad.errors, HasSubstr("made for another scene"));
    EXPECT_TRUE(has("l.0006.exr")) << "what is finished is kept";
}

TEST_F(Frames, ShareTheirExposure) {
    NEARLIGHT_NEEDS_DEVICE();
    static_cast<void>(rendered("--frames 3:8 --fps 4", "a.png"));
    static_cast<void>(rendered("--frames 8 --fps 4", "alone.png"));
    const auto exposure = [&](const std::string& name) {
        return std::get<std::string>(read_metadata(folder_ / name).at("nearlight:exposure"));
    };
    EXPECT_EQ(exposure("a.0003.png"), exposure("a.0008.png"));
    EXPECT_EQ(exposure("a.0008.png"), exposure("alone.0008.png"));
    EXPECT_NE(exposure("a.0003.png"), "+0.000");
}

TEST_F(Frames, ThatAreThereCanBeSkipped) {
    NEARLIGHT_NEEDS_DEVICE();
    std::ofstream(folder_ / "a.0001.exr") << "there";
    const nlohmann::json json = rendered("--frames 0:2 --skip-existing");
    ASSERT_EQ(json["frames"].size(), 2u);
    EXPECT_EQ(json["frames"][1]["frame"], 2);
    EXPECT_EQ(file_text(folder_ / "a.0001.exr"), "there");
    EXPECT_EQ(rendered("--frames 0:2 --skip-existing")["frames"].size(), 0u);
}

TEST_F(Frames, ThatWereInterruptedAreNotWritten) {
    NEARLIGHT_NEEDS_DEVICE();
    const std::string arguments = "render --frames 0:99 --size 24x16 --vpls 60 --time 0.5 --skip-existing " +
                                  quoted(scene_) + " -o " + quoted(folder_ / "t.exr");
    const ProgramResult result =
        run_interrupted(arguments, 2.5, [&](const ProgramResult&) { return has("t.0000.exr"); });
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_FALSE(has("t.0099.exr"));
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / ".")) {
        if (entry.path().filename().string().starts_with("t.")) {
            EXPECT_GT(read_image(entry.path()).values.size(), 0u) << entry.path();
            ++count;
        }
    }
    EXPECT_THAT(result.errors,
                HasSubstr("interrupted: " + std::to_string(count) + " of 100 frames are finished"));
}

TEST_F(Frames, BadInputIsOneClearMessage) {
    const std::string still = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{}]})";
    std::ofstream(folder_ / "still.gltf") << still;
    std::ofstream(folder_ / "still.xml") << "<scene version='3.0.0'/>";
    struct Case {
        std::string options;
        std::string scene;
        int exit_code;
        std::string message;
    };
    for (const Case& bad :
         {Case{"--frames 5:2", "room.gltf", 2, "ends before it begins; give 2:5"},
          {"--frames 1:2000000", "room.gltf", 2, "with numbers from 0 to 999999"},
          {"--frames x", "room.gltf", 2, "--frames must be A:B or A"},
          {"--fps 25", "room.gltf", 2, "--fps requires --frames"},
          {"--frames 1 --fps 0", "room.gltf", 2, "--fps"},
          {"--frames 1 --fps nan", "room.gltf", 2, "--fps"},
          {"--frames 1 --checkpoint c", "room.gltf", 2, "--checkpoint"},
          {"--frames 1 --save-vpls v", "room.gltf", 2, "--save-vpls"},
          {"--frames 1 --animation run", "room.gltf", 2, "has no animation 'run'"},
          {"--frames 1 --origin 0,1,2", "room.gltf", 2, "needs --target too"},
          // Both files are whole scenes, so that the option is to blame.
          {"--frames 1", "still.gltf", 2, "has no animations; leave out --frames for a picture of it"},
          {"--frames 1", "still.xml", 2, "have animations; leave out --frames for a picture of it"}}) {
        const ProgramResult result = run_program("render " + bad.options + " " + quoted(folder_ / bad.scene) +
                                                 " -o " + quoted(folder_ / "x.exr"));
        EXPECT_EQ(result.exit_code, bad.exit_code) << bad.options << ": " << result.errors;
        EXPECT_THAT(result.errors, HasSubstr(bad.message));
        EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
    }
}

TEST_F(Frames, OutsideOfTheAnimationShowItsEndsAndSaySo) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result = render("--frames 8:10 --fps 4", "e.exr");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.errors, HasSubstr("the animation ends at frame 8; the frames after it show its end"));
    const std::vector<std::string> all = hashes(nlohmann::json::parse(result.output));
    EXPECT_EQ(all[0], all[1]);
    EXPECT_EQ(all[0], all[2]);
    EXPECT_THAT(render("--frames 8 --fps 4", "e.exr").errors, Not(HasSubstr("the animation ends")));
}

}  // namespace
}  // namespace nearlight::core
