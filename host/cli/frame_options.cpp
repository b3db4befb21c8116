// SPDX-License-Identifier: Apache-2.0
#include "host/cli/frame_options.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "host/base/limits.h"
#include "host/cli/log.h"
#include "host/cli/pass_options.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kUsualDigits = 4;

std::optional<int> frame_in(std::string_view text) {
    int frame = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
    const bool is_frame =
        error == std::errc() && end == text.data() + text.size() && frame >= 0 && frame <= kMaxFrame;
    return is_frame ? std::optional(frame) : std::nullopt;
}

std::string with_zeros(int frame, std::size_t digits) {
    const std::string text = std::to_string(frame);
    return std::string(digits - std::min(digits, text.size()), '0') + text;
}

bool are_there(const std::vector<std::string>& files) {
    return std::ranges::all_of(files, [](const std::string& file) {
        std::error_code error;
        return std::filesystem::exists(file, error);
    });
}

}  // namespace

void add_frame_options(CLI::App& command, FrameOptions& options) {
    auto* const frames =
        command
            .add_option_function<std::string>(
                "--frames", [&options](const std::string& text) { options.range = parse_frames(text); },
                "Render the frames A to B, both included, of a glTF file's animation, or only frame A; frame "
                "N "
                "shows the time N / --fps. In the name of -o, #### stands for the number, which otherwise "
                "comes before the extension")
            ->type_name("A[:B]");
    const auto needs_frames = [frames](CLI::Option* option) { return option->needs(frames); };
    needs_frames(command.add_option("--fps", options.animation.fps, "Frames per second, with --frames"))
        ->check(number_from(0.001, 1e6))
        ->type_name("N")
        ->capture_default_str();
    needs_frames(command.add_option("--animation", options.animation.animations,
                                    "Animation to play, by its name or number; may be given several times "
                                    "(default: all, but of those that move the same thing only the first)"))
        ->type_name("NAME|N")
        ->allow_extra_args(false);
    needs_frames(
        command.add_option(
            "--vpl-keys", options.animation.vpl_keys,
            "Where only the camera moves, VPLs are made for the views of every N-th frame, and fade from "
            "one to the next so that they hardly flicker; 0: anew for each frame (default: as many as "
            "--fps)"))
        ->check(CLI::Range(0, kMaxFrame))
        ->type_name("N");
    needs_frames(command.add_flag("--skip-existing", options.skip_existing,
                                  "Leave out frames of which all files are there"));
    // These belong to one picture.
    for (const char* option : {"--checkpoint", "--checkpoint-every", "--first-pass", "--save-vpls"}) {
        frames->excludes(command.get_option(option));
    }
}

FrameRange parse_frames(const std::string& text) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::string_view begin = std::string_view(text).substr(0, colon);
    const std::optional<int> first = frame_in(begin);
    const std::optional<int> last =
        colon < text.size() ? frame_in(std::string_view(text).substr(colon + 1)) : first;
    if (!first || !last) {
        throw Error(ErrorKind::invalid_argument,
                    fmt::format("--frames must be A:B or A, with numbers from 0 to {}, as in 1:48, not '{}'",
                                kMaxFrame, text));
    }
    if (*first > *last) {
        throw Error(ErrorKind::invalid_argument,
                    fmt::format("--frames {} ends before it begins; give {}:{}", text, *last, *first));
    }
    return {*first, *last};
}

std::string numbered(const std::string& file, int frame) {
    const std::filesystem::path path(file);
    const std::string name = path.filename().string();
    const std::size_t end = name.find_last_of('#');
    if (end == std::string::npos) {
        const std::string stem = path.stem().string() + "." + with_zeros(frame, kUsualDigits);
        return std::filesystem::path(path).replace_filename(stem + path.extension().string()).string();
    }
    const std::size_t before = name.find_last_not_of('#', end);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    return std::filesystem::path(path)
        .replace_filename(name.substr(0, begin) + with_zeros(frame, end + 1 - begin) + name.substr(end + 1))
        .string();
}

std::vector<std::string> numbered(const std::vector<std::string>& files, int frame) {
    std::vector<std::string> names;
    for (const std::string& file : files) {
        names.push_back(numbered(file, frame));
    }
    return names;
}

std::vector<int> frames_to_make(const FrameOptions& options, const std::vector<std::string>& outputs) {
    std::vector<int> frames;
    for (int frame = options.range->first; frame <= options.range->last; ++frame) {
        if (!options.skip_existing || !are_there(numbered(outputs, frame))) {
            frames.push_back(frame);
        }
    }
    return frames;
}

void tell_range(const FrameOptions& options, const Scene& scene) {
    constexpr double kRounding = 1e-3;  // of a frame
    const double begin = scene.animation->begin * options.animation.fps;
    const double end = scene.animation->end * options.animation.fps;
    if (options.range->first < begin - kRounding) {
        spdlog::warn("the animation begins at frame {:.4g}; the frames before show its begin", begin);
    }
    if (options.range->last > end + kRounding) {
        spdlog::warn("the animation ends at frame {:.4g}; the frames after it show its end", end);
    }
}

}  // namespace nearlight::core
