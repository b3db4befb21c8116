// SPDX-License-Identifier: Apache-2.0
// What the program `nearlight` asks of the viewer, which is a module that it loads for `nearlight view`,
// because nothing else needs the libraries of windows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nearlight/device.h"
#include "nearlight/error.h"
#include "nearlight/image.h"
#include "nearlight/message.h"
#include "nearlight/scene.h"
#include "nearlight/settings.h"

namespace nearlight::viewer {

/// The largest picture that a window shows, in pixels. The viewer keeps a few pictures with all layers in
/// memory, about 100 bytes a pixel each.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 25;

/// Throws Error(ErrorKind::out_of_memory), with the setting "size", for a picture of more than kMaxPixels.
inline void check_size(int width, int height) {
    if (std::int64_t{width} * height > kMaxPixels) {
        throw Error(ErrorKind::out_of_memory,
                    std::to_string(width) + "x" + std::to_string(height) +
                        " pixels are too many for a window: the maximum is " +
                        std::to_string(kMaxPixels >> 20) + " million",
                    "size");
    }
}

/// A place in the finished picture.
struct Pixel {
    int x = 0;  ///< from the left
    int y = 0;  ///< from the top
};

struct ViewerTask {
    std::filesystem::path scene;
    LoadOptions load{};
    std::string device = "auto";
    DeviceOptions device_options{};
    RenderSettings settings{};            ///< of a finished picture
    std::optional<float> exposure{};      ///< stops; empty: as the scene asks, or else by its first picture
    bool has_automatic_exposure = false;  ///< by the first picture, whatever the scene asks
    std::optional<ToneCurve> curve{};     ///< empty: as the scene asks
    /// The arguments of a command line that say what scene to load and how.
    std::vector<std::string> scene_arguments{};
    std::vector<std::string> camera_arguments{};  ///< those that place the camera at the start
    MessageSink messages{};                       ///< gets the library's warnings, in any thread
    std::string tev{};  ///< HOST:PORT of the image viewer tev, which gets whole pictures too; empty: none

    // For tests, screenshots and measurements.
    /// Ends when the picture has so many samples per pixel; 0: when the window closes.
    std::uint32_t until_samples = 0;
    std::filesystem::path screenshot{};  ///< gets the window's content before the end; empty: none
    std::optional<Pixel> inspect{};      ///< inspects this pixel before the screenshot
    bool shows_vpls = false;
    std::size_t layer = 0;  ///< among those that files get unless others are asked for
    /// Moves the camera about without a window, and says how soon pictures come.
    bool measures = false;
    std::function<bool()> is_interrupted{};  ///< whether to end
};

/// What a measurement found; nothing of value if it was interrupted.
struct ViewerReport {
    double moving_frames_per_second = 0.0;
    int moving_divisor = 1;             ///< of the picture's size during the motion
    double first_full_seconds = 0.0;    ///< from the last camera move to a picture of full size, the median
    double slowest_full_seconds = 0.0;  ///< the same, the longest
    /// Processor time of the whole program for the same, the median: divided by the number of cores, it is
    /// about what the move takes on an idle machine.
    double first_full_processor_seconds = 0.0;
    double pass_seconds = 0.0;  ///< of a refining pass, the median
    int width = 0;
    int height = 0;
};

/// Shows the scene until the window is closed. Throws Error: ErrorKind::failure if there is no display, and
/// what loading and rendering throw.
using RunViewer = ViewerReport (*)(const ViewerTask& task);
/// The name of that function in the module.
inline constexpr const char* kRunViewerName = "nearlight_run_viewer";

}  // namespace nearlight::viewer
