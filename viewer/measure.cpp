// SPDX-License-Identifier: Apache-2.0
#include "viewer/measure.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "nearlight/error.h"
#include "viewer/camera_motion.h"
#include "viewer/renderer.h"
#include "viewer/task_scene.h"

namespace nearlight::viewer {
namespace {

constexpr double kMotionSeconds = 4.0;
constexpr std::chrono::milliseconds kInputPeriod{16};
constexpr std::chrono::milliseconds kPollPeriod{1};
constexpr float kTurnPerInput = 0.004f;
constexpr int kSingleMoves = 9;
constexpr std::uint32_t kPasses = 8;
constexpr std::uint32_t kRestingSamples = 2;

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

double processor_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// What it took from a move to a picture of full size.
struct Move {
    double seconds = 0.0;
    double processor_seconds = 0.0;
};

/// A hand that moves the camera, and what it sees. What waits for a picture returns nothing, or false, if the
/// program is interrupted.
class Hand {
  public:
    explicit Hand(const ViewerTask& task)
        : task_(task),
          settings_(task.settings),
          renderer_(
              Devices::choose(task.device, task.device_options), [&task] { return load_scene(task); },
              task.settings, [] {}) {}

    /// Waits for the first picture and takes its camera. Returns false if the program is interrupted.
    bool take_camera() {
        if (!comes([](const Frame& frame) { return frame.divisor == 1; })) {
            return false;
        }
        const Scene scene = *renderer_.scene();
        camera_ = free_camera(scene.camera(), scene.bounds());
        return true;
    }

    /// Moves the camera all the time, and returns how many small pictures came in a second.
    std::optional<double> frames_per_second_in_motion() {
        // The first seconds choose the size of the small pictures.
        if (!move_about(1.0)) {
            return std::nullopt;
        }
        const std::optional<int> count = move_about(kMotionSeconds);
        return count ? std::optional(*count / kMotionSeconds) : std::nullopt;
    }

    /// A single move until there is a picture of full size.
    std::optional<Move> single_move() {
        // Right after a first picture VPLs are made, which cannot be stopped; most moves come later.
        const std::uint32_t enough = std::min(kRestingSamples, settings_.gather.samples_per_pixel);
        if (!comes([&](const Frame& frame) { return frame.samples >= enough; })) {
            return std::nullopt;
        }
        const std::uint64_t before = frame_->state;
        const double processor = processor_seconds();
        turn(10 * kTurnPerInput);
        if (!comes([&](const Frame& frame) { return frame.divisor == 1 && frame.state > before; })) {
            return std::nullopt;
        }
        return Move{.seconds = frame_->seconds_to_full, .processor_seconds = processor_seconds() - processor};
    }

    /// The seconds of each of the passes that follow.
    std::optional<std::vector<double>> pass_seconds() {
        std::vector<double> seconds;
        while (seconds.size() < kPasses && frame_->samples < settings_.gather.samples_per_pixel) {
            const std::uint32_t samples = frame_->samples;
            if (!comes([&](const Frame& frame) { return frame.samples > samples; })) {
                return std::nullopt;
            }
            seconds.push_back(frame_->seconds);
        }
        return seconds;
    }

    [[nodiscard]] const Frame& frame() const { return *frame_; }

  private:
    void turn(float angle) {
        camera_ = orbit(camera_, angle, 0.0f);
        settings_.view.camera = pose_of(camera_);
        renderer_.show(settings_, Change::camera);
    }

    [[nodiscard]] bool is_interrupted() const { return task_.is_interrupted && task_.is_interrupted(); }

    /// Returns how many pictures came.
    std::optional<int> move_about(double seconds) {
        const Clock::time_point begin = Clock::now();
        int frames = 0;
        while (std::chrono::duration<double>(Clock::now() - begin).count() < seconds) {
            if (is_interrupted()) {
                return std::nullopt;
            }
            turn(kTurnPerInput);
            std::this_thread::sleep_for(kInputPeriod);
            frames += take_frame() ? 1 : 0;
        }
        return frames;
    }

    /// Whether there is a new frame. Throws what the renderer could not do.
    bool take_frame() {
        renderer_.rethrow_failure();
        renderer_.rethrow_error();
        std::shared_ptr<const Frame> frame = renderer_.frame();
        const bool is_new = frame && frame != frame_;
        frame_ = std::move(frame);
        return is_new;
    }

    /// Waits until the latest frame is as wanted, which it may be already. Returns false if the program is
    /// interrupted.
    template <typename Condition>
    bool comes(const Condition& is_wanted) {
        for (take_frame(); !(frame_ && is_wanted(*frame_)); take_frame()) {
            if (is_interrupted()) {
                return false;
            }
            std::this_thread::sleep_for(kPollPeriod);
        }
        return true;
    }

    const ViewerTask& task_;
    RenderSettings settings_;
    FreeCamera camera_;
    std::shared_ptr<const Frame> frame_;
    Renderer renderer_;
};

}  // namespace

ViewerReport measure(const ViewerTask& task) {
    Hand hand(task);
    const std::optional<double> in_motion =
        hand.take_camera() ? hand.frames_per_second_in_motion() : std::nullopt;
    if (!in_motion) {
        return {};
    }
    ViewerReport report{.moving_frames_per_second = *in_motion, .moving_divisor = hand.frame().divisor};
    std::vector<double> moves;
    std::vector<double> processor;
    for (int i = 0; i < kSingleMoves; ++i) {
        const std::optional<Move> move = hand.single_move();
        if (!move) {
            return {};
        }
        moves.push_back(move->seconds);
        processor.push_back(move->processor_seconds);
    }
    const std::optional<std::vector<double>> passes = hand.pass_seconds();
    if (!passes) {
        return {};
    }
    report.first_full_seconds = median(moves);
    report.slowest_full_seconds = *std::ranges::max_element(moves);
    report.first_full_processor_seconds = median(processor);
    report.pass_seconds = median(*passes);
    report.width = hand.frame().image.width;
    report.height = hand.frame().image.height;
    return report;
}

}  // namespace nearlight::viewer
