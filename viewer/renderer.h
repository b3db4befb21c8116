// SPDX-License-Identifier: Apache-2.0
// Renders in a thread of its own, so that the window never waits.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "nearlight/session.h"
#include "viewer/frame.h"
#include "viewer/pass_mean.h"
#include "viewer/refinement.h"

namespace nearlight::viewer {

/// What changes with a request.
enum class Change {
    camera,    ///< VPLs of the view before serve until the motion ends
    sampling,  ///< VPLs are made anew
};

/// The thread with its session. All functions are for the thread that made it.
class Renderer {
  public:
    /// Begins to load the scene and to get a session ready. The settings are those of a finished picture; its
    /// passes, one for each sample of a pixel, share them. `on_news` is called in the renderer's thread
    /// whenever there is something new to show, and must not call the renderer.
    Renderer(Devices devices, std::function<Scene()> load, const RenderSettings& settings,
             std::function<void()> on_news);
    /// Stops what is under way and waits for it.
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// The scene, as soon as it is loaded.
    [[nodiscard]] std::optional<Scene> scene() const;
    /// Shows something else from now on. Work on what was shown before stops within a band of the picture,
    /// or is finished if it is a small picture.
    void show(const RenderSettings& settings, Change change);
    /// Another number of passes for the same picture, which goes on.
    void set_samples(std::uint32_t samples_per_pixel);
    /// Lets work rest after the step that is under way, or go on.
    void pause(bool is_paused);
    /// The latest frame; nothing if there was none yet.
    [[nodiscard]] std::shared_ptr<const Frame> frame() const;
    /// Whether the latest request has all its passes.
    [[nodiscard]] bool is_done() const;

    /// Asks what lights a pixel of a frame. The answer comes as inspection().
    void inspect(std::shared_ptr<const Frame> frame, int x, int y);
    /// The latest answer; nothing if there was none yet.
    [[nodiscard]] std::shared_ptr<const Inspection> inspection() const;

    /// Rethrows what kept the scene or the session from getting ready, if anything did.
    void rethrow_failure() const;
    /// The error of the latest step, as a line; empty if it succeeded.
    [[nodiscard]] std::string error() const;
    /// Rethrows that error, if there is one.
    void rethrow_error() const;

  private:
    using Clock = std::chrono::steady_clock;
    struct InspectionJob {
        std::shared_ptr<const Frame> frame;
        int x = 0;
        int y = 0;
    };
    /// A step, or what to inspect.
    struct Job {
        Step step{};
        RenderSettings settings{};
        std::uint64_t sampling_change = 0;
        Clock::time_point changed_at{};
        std::optional<InspectionJob> inspected{};
    };

    void run(const Devices& devices, const std::function<Scene()>& load);
    std::optional<Job> next_job();
    void do_job(Session& session, const Job& job);
    void render(Session& session, const Job& job);
    std::optional<Image> gather(Session& session, const Job& job, Frame& frame);
    void add_pass(const Job& job, Frame& frame, Image&& pass);
    [[nodiscard]] bool is_wanted(const Step& step) const;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // The mutex guards the following members.
    RenderSettings settings_;
    Clock::time_point changed_at_ = Clock::now();
    Refinement refinement_;
    bool is_paused_ = false;
    bool is_stopping_ = false;
    std::uint64_t sampling_change_ = 0;  ///< counts the changes of what VPLs depend on
    std::optional<InspectionJob> to_inspect_;
    std::optional<Scene> scene_;
    std::shared_ptr<const Frame> frame_;
    std::shared_ptr<const Inspection> inspection_;
    std::exception_ptr failure_;
    std::exception_ptr error_;
    std::string error_text_;

    const std::function<void()> on_news_;
    // Only the renderer's thread uses the following members.
    std::optional<VplSet> vpls_;
    std::uint64_t vpls_change_ = 0;  ///< the change of sampling that the VPLs were made for
    std::shared_ptr<const std::vector<VirtualPointLight>> lights_;  ///< the VPLs; null until asked for
    PassMean mean_;
    double seconds_to_full_ = 0.0;  ///< of the latest first picture
    std::jthread thread_;           ///< declared last, because it uses the others
};

}  // namespace nearlight::viewer
