// SPDX-License-Identifier: Apache-2.0
// `nearlight view` with a window on a display that exists in memory only.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>

#include "host/cl/devices/device_list.h"
#include "host/image/image_io.h"
#include "tests/cli/run_program.h"
#include "tests/image/temporary_folder.h"
#include "tests/support/device_required.h"
#include "tests/viewer/virtual_display.h"

namespace nearlight::core {
namespace {

const std::string kFloor = std::string(NEARLIGHT_SOURCE_DIR) + "/tests/install/floor.xml";
const std::string kWithoutDisplay = "env -u DISPLAY -u WAYLAND_DISPLAY";

std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

void expect_error(const ProgramResult& result, int exit_code, const std::string& part) {
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    EXPECT_EQ(lines(result.errors), 1u) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
}

TEST(ViewCommand, WithoutADisplayThereIsOneClearLine) {
    expect_error(run_program("view " + kFloor, kWithoutDisplay), 1, "cannot open a window");
}

TEST(ViewCommand, MistakesAreToldBeforeAWindowOpens) {
    expect_error(run_program("view nosuch.xml", kWithoutDisplay), 3, "nosuch.xml");
    expect_error(run_program("view " + kFloor + " --layer nosuch", kWithoutDisplay), 2, "beauty, direct");
    expect_error(run_program("view " + kFloor + " --range far", kWithoutDisplay), 2, "--range");
    expect_error(run_program("view " + kFloor + " --size 65536x65536", kWithoutDisplay), 6,
                 "32 million; use a smaller --size\n");
    expect_error(
        run_program("view " + kFloor + " --until-samples 1 --screenshot nosuch/window.png", kWithoutDisplay),
        3, "there is no folder 'nosuch'; create it first");
}

TEST(ViewCommand, TheSizeOfTheSceneItselfIsLimitedToo) {
    NEARLIGHT_NEEDS_DEVICE();
    const TemporaryFolder folder;
    std::ofstream(folder / "large.xml")
        << "<scene version='3.0.0'><sensor type='perspective'><film type='hdrfilm'><integer name='width' "
           "value='8192'/><integer name='height' value='8192'/></film></sensor><shape type='cube'/></scene>";
    const ProgramResult result =
        run_program("view --measure " + quoted(folder / "large.xml"), kWithoutDisplay);
    EXPECT_EQ(result.exit_code, 6) << result.errors;
    EXPECT_NE(result.errors.find("too many for a window"), std::string::npos) << result.errors;
}

/// Each of them would otherwise do nothing, or only after the picture is finished.
TEST(ViewCommand, PixelsAndScreenshotsAreCheckedBeforeAWindowOpens) {
    const auto errors_of = [](const std::string& options) {
        const ProgramResult result = run_program("view " + kFloor + " " + options, kWithoutDisplay);
        EXPECT_EQ(result.exit_code, 2) << options;
        return result.errors;
    };
    EXPECT_NE(errors_of("--screenshot window.png").find("--screenshot requires --until-samples"),
              std::string::npos);
    EXPECT_NE(errors_of("--inspect 1,2").find("--inspect requires --until-samples"), std::string::npos);
    EXPECT_NE(errors_of("--measure --show-vpls").find("--show-vpls excludes --measure"), std::string::npos);
    for (const char* const pixel : {"1", "1,2,3", "1,-2", "1,2x", "1,", "x,y", "1.5,2"}) {
        EXPECT_NE(errors_of(std::string("--until-samples 1 --inspect=") + pixel).find("--inspect"),
                  std::string::npos)
            << pixel;
    }
}

TEST(ViewCommand, MeasuresWithoutADisplay) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result =
        run_program("view " + kFloor + " --size 64x48 --vpls 50 --spp 2 --measure --json", kWithoutDisplay);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("\"first_full_seconds\""), std::string::npos) << result.output;
}

/// A picture may be finished before the hand looks for it: with a single sample nothing more comes then.
TEST(ViewCommand, MeasuresPicturesOfOneSample) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result =
        run_program("view " + kFloor + " --size 16x12 --vpls 5 --spp 1 --measure --json",
                    kWithoutDisplay + " timeout 120");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
}

/// The measurement moves the camera for several seconds.
TEST(ViewCommand, CtrlCEndsAMeasurement) {
    NEARLIGHT_NEEDS_DEVICE();
    const ProgramResult result =
        run_program("view " + kFloor + " --size 512x512 --spp 4096 --measure",
                    kWithoutDisplay + " timeout --foreground --preserve-status --signal=INT 3");
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_EQ(result.errors, "");
    EXPECT_EQ(result.output, "");
}

class ViewWindow : public testing::Test {
  protected:
    void SetUp() override {
        NEARLIGHT_NEEDS_DEVICE();
        if (!display_.is_there()) {
            GTEST_SKIP() << "Xvfb is not installed (Debian's package xvfb)";
        }
    }
    [[nodiscard]] std::filesystem::path screenshot() const { return folder_ / "window.png"; }
    ProgramResult view_floor(const std::string& options, const std::string& before = "") const {
        return run_program("view " + kFloor + " " + options, display_.prefix() + " " + before);
    }
    VirtualDisplay display_;
    TemporaryFolder folder_;
};

/// The panel stands on the left, and the lit floor in the middle of what is right of it.
TEST_F(ViewWindow, ShowsThePicture) {
    const ProgramResult result = view_floor(
        "--size 256x256 --vpls 100 --spp 2 --until-samples 2 --show-vpls --inspect 128,128 --screenshot " +
        quoted(screenshot()));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const Image window = read_image(screenshot());
    EXPECT_GT(window.width, 256);
    EXPECT_GE(window.height, 256);
    const int middle = window.width - 128;
    EXPECT_GT(window.at(middle + 40, window.height / 2 + 40, 2), 0.3f);
    EXPECT_LT(window.at(window.width - 3, 3, 2), 0.2f);
}

/// From above, with x upwards, what is farther up in the picture has a greater x, and so more red.
TEST_F(ViewWindow, TakesWhatPointsUpwards) {
    const ProgramResult result = view_floor(
        "--size 256x256 --vpls 50 --spp 1 --origin 0,0,3 --target 0,0,0 --up 1,0,0 --layer P --until-samples "
        "1 "
        "--screenshot " +
        quoted(screenshot()));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const Image window = read_image(screenshot());
    const int middle = window.width - 128;
    EXPECT_GT(window.at(middle, window.height / 2 - 50, 0), 0.7f);
    EXPECT_LT(window.at(middle, window.height / 2 + 50, 0), 0.3f);
}

/// There may be fewer samples than frames that are asked for, and scenes that no frame follows.
TEST_F(ViewWindow, EndsWhenNothingMoreComes) {
    EXPECT_EQ(view_floor("--size 64x64 --vpls 50 --spp 1 --until-samples 9", "timeout 60").exit_code, 0);
    expect_error(view_floor("--size 64x64 --origin 0,0,1 --target 0,0,1 --until-samples 1", "timeout 60"), 2,
                 "camera");
}

TEST_F(ViewWindow, PixelsOutsideOfThePictureAreErrors) {
    for (const char* const pixel : {"64,0", "0,48"}) {
        expect_error(
            view_floor(std::string("--size 64x48 --until-samples 1 --inspect ") + pixel, "timeout 60"), 2,
            std::string("no pixel ") + pixel + " to inspect in a picture of 64x48");
    }
}

TEST_F(ViewWindow, CtrlCClosesItInTheMiddle) {
    const ProgramResult result =
        view_floor("--size 512x512 --spp 4096", "timeout --foreground --preserve-status --signal=INT 6");
    EXPECT_EQ(result.exit_code, 130) << result.errors;
    EXPECT_EQ(result.errors, "");
}

/// A display that goes away, as a remote one does, ends the program without a crash. Other load may delay the
/// window, which must be there before: then a display lives twice as long.
TEST_F(ViewWindow, ALostDisplayEndsIt) {
    ProgramResult result;
    for (std::chrono::seconds life{6}; life < std::chrono::seconds(100); life *= 2) {
        VirtualDisplay display;
        std::thread ending([&] {
            std::this_thread::sleep_for(life);
            display.end();
        });
        result =
            run_program("view " + kFloor + " --size 512x512 --spp 4096", display.prefix() + " timeout 120");
        ending.join();
        if (result.errors.find("cannot open a window") == std::string::npos) {
            break;
        }
    }
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    EXPECT_EQ(result.errors.find("cannot open a window"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace nearlight::core
