// SPDX-License-Identifier: Apache-2.0
#include "viewer/measure.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>
#include <vector>

#include "nearlight/error.h"
#include "viewer/camera_motion.h"
#include "viewer/renderer.h"

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

/// A hand that moves the camera, and what it sees.
class Hand {
  public:
    explicit Hand(const ViewerTask& task)
        : task_(task),
          settings_(task.settings),
          renderer_(
              Devices::choose(task.device, task.device_options),
              [&task] { return Scene::load(task.scene, task.load); }, task.settings, [] {}) {
        wait_for([](const Frame& frame) { return frame.divisor == 1; });
        const Scene scene = *renderer_.scene();
        camera_ = free_camera(scene.camera(), scene.bounds());
    }

    /// Moves the camera all the time, and returns how many small pictures came in a second.
    double frames_per_second_in_motion() {
        // The first seconds choose the size of the small pictures.
        move_about(1.0);
        const int count = move_about(kMotionSeconds);
        return count / kMotionSeconds;
    }

    /// A single move until there is a picture of full size.
    Move single_move() {
        // Right after a first picture VPLs are made, which cannot be stopped; most moves come later.
        const std::uint32_t enough = std::min(kRestingSamples, settings_.gather.samples_per_pixel);
        wait_for([&](const Frame& frame) { return !frame.is_quick && frame.samples >= enough; });
        const std::uint64_t before = frame_->state;
        const double processor = processor_seconds();
        turn(10 * kTurnPerInput);
        wait_for([&](const Frame& frame) { return frame.divisor == 1 && frame.state > before; });
        return {.seconds = frame_->seconds_since_change,
                .processor_seconds = processor_seconds() - processor};
    }

    /// The seconds of each of the passes that follow.
    std::vector<double> pass_seconds() {
        std::vector<double> seconds;
        while (seconds.size() < kPasses && !renderer_.is_done()) {
            const std::uint32_t samples = frame_->is_quick ? 0 : frame_->samples;
            wait_for([&](const Frame& frame) { return !frame.is_quick && frame.samples > samples; });
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

    int move_about(double seconds) {
        const Clock::time_point begin = Clock::now();
        int frames = 0;
        while (std::chrono::duration<double>(Clock::now() - begin).count() < seconds) {
            turn(kTurnPerInput);
            std::this_thread::sleep_for(kInputPeriod);
            frames += take_frame() ? 1 : 0;
        }
        return frames;
    }

    /// Whether there is a new frame.
    bool take_frame() {
        renderer_.rethrow_failure();
        std::shared_ptr<const Frame> frame = renderer_.frame();
        const bool is_new = frame && frame != frame_;
        frame_ = std::move(frame);
        return is_new;
    }

    template <typename Condition>
    void wait_for(const Condition& is_enough) {
        while (!(take_frame() && is_enough(*frame_))) {
            if (task_.is_interrupted && task_.is_interrupted()) {
                throw Error(ErrorKind::failure, "the measurement was interrupted");
            }
            if (const std::string error = renderer_.error(); !error.empty()) {
                throw Error(ErrorKind::failure, error);
            }
            std::this_thread::sleep_for(kPollPeriod);
        }
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
    ViewerReport report;
    report.moving_frames_per_second = hand.frames_per_second_in_motion();
    report.moving_divisor = hand.frame().divisor;
    std::vector<double> moves;
    std::vector<double> processor;
    for (int i = 0; i < kSingleMoves; ++i) {
        const Move move = hand.single_move();
        moves.push_back(move.seconds);
        processor.push_back(move.processor_seconds);
    }
    report.first_full_seconds = median(moves);
    report.slowest_full_seconds = *std::ranges::max_element(moves);
    report.first_full_processor_seconds = median(processor);
    report.pass_seconds = median(hand.pass_seconds());
    report.width = hand.frame().image.width;
    report.height = hand.frame().image.height;
    return report;
}

}  // namespace nearlight::viewer
