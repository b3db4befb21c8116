// SPDX-License-Identifier: Apache-2.0
#include "viewer/renderer.h"

#include <algorithm>
#include <utility>

#include "viewer/pass_settings.h"
#include "viewer/smooth.h"

namespace nearlight::viewer {
namespace {

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

/// Pictures with fewer samples per pixel are shown smoothed, because their pixels ask so few VPLs that a
/// pattern is seen.
constexpr std::uint32_t kUnsmoothedSamples = 8;

/// Passes of a picture: the first quick one, and one for each sample of a pixel.
std::uint32_t passes_of(const RenderSettings& settings) {
    return 1 + std::max(settings.gather.samples_per_pixel, 1u);
}

}  // namespace

Renderer::Renderer(Devices devices, std::function<Scene()> load, const RenderSettings& settings,
                   std::function<void()> on_news)
    : settings_(settings),
      refinement_(passes_of(settings)),
      on_news_(std::move(on_news)),
      thread_([this, devices = std::move(devices), load = std::move(load)] { run(devices, load); }) {}

Renderer::~Renderer() {
    {
        const std::lock_guard lock(mutex_);
        is_stopping_ = true;
    }
    changed_.notify_all();
}

std::optional<Scene> Renderer::scene() const {
    const std::lock_guard lock(mutex_);
    return scene_;
}

void Renderer::show(const RenderSettings& settings, Change change) {
    {
        const std::lock_guard lock(mutex_);
        settings_ = settings;
        changed_at_ = Clock::now();
        refinement_.set_max_passes(passes_of(settings));
        refinement_.restart();
        sampling_change_ += change == Change::sampling ? 1 : 0;
    }
    changed_.notify_all();
}

void Renderer::set_samples(std::uint32_t samples_per_pixel) {
    {
        const std::lock_guard lock(mutex_);
        settings_.gather.samples_per_pixel = samples_per_pixel;
        refinement_.set_max_passes(passes_of(settings_));
        if (frame_ && frame_->smoothed && !refinement_.next()) {
            Frame finished = *frame_;
            finished.smoothed.reset();
            frame_ = std::make_shared<const Frame>(std::move(finished));
        }
    }
    changed_.notify_all();
}

void Renderer::pause(bool is_paused) {
    {
        const std::lock_guard lock(mutex_);
        is_paused_ = is_paused;
    }
    changed_.notify_all();
}

std::shared_ptr<const Frame> Renderer::frame() const {
    const std::lock_guard lock(mutex_);
    return frame_;
}

bool Renderer::is_done() const {
    const std::lock_guard lock(mutex_);
    return frame_ && !refinement_.next();
}

void Renderer::inspect(std::shared_ptr<const Frame> frame, int x, int y) {
    {
        const std::lock_guard lock(mutex_);
        to_inspect_ = {std::move(frame), x, y};
    }
    changed_.notify_all();
}

std::shared_ptr<const Inspection> Renderer::inspection() const {
    const std::lock_guard lock(mutex_);
    return inspection_;
}

void Renderer::rethrow_failure() const {
    const std::lock_guard lock(mutex_);
    if (failure_) {
        std::rethrow_exception(failure_);
    }
}

std::string Renderer::error() const {
    const std::lock_guard lock(mutex_);
    return error_text_;
}

void Renderer::rethrow_error() const {
    const std::lock_guard lock(mutex_);
    if (error_) {
        std::rethrow_exception(error_);
    }
}

void Renderer::run(const Devices& devices, const std::function<Scene()>& load) {
    try {
        const Scene scene = load();
        {
            const std::lock_guard lock(mutex_);
            scene_ = scene;
        }
        on_news_();
        Session session(devices, scene);
        while (const std::optional<Job> job = next_job()) {
            do_job(session, *job);
            on_news_();
        }
        // These VPLs go before their session; those that frames hold keep what they need of it.
        vpls_.reset();
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
    }
    on_news_();
}

/// Waits for something to do. Returns nothing when the renderer is to end.
std::optional<Renderer::Job> Renderer::next_job() {
    std::unique_lock lock(mutex_);
    std::optional<Step> step;
    changed_.wait(lock, [&] {
        step = is_paused_ ? std::nullopt : refinement_.next();
        return is_stopping_ || to_inspect_ || step;
    });
    if (is_stopping_) {
        return std::nullopt;
    }
    if (to_inspect_) {
        return Job{.inspected = std::exchange(to_inspect_, std::nullopt)};
    }
    return Job{
        .step = *step, .settings = settings_, .sampling_change = sampling_change_, .changed_at = changed_at_};
}

void Renderer::do_job(Session& session, const Job& job) {
    std::exception_ptr error;
    std::string text;
    try {
        if (job.inspected) {
            const InspectionJob& at = *job.inspected;
            auto answer = std::make_shared<const Inspection>(viewer::inspect(session, *at.frame, at.x, at.y));
            const std::lock_guard lock(mutex_);
            inspection_ = std::move(answer);
            return;
        }
        render(session, job);
    } catch (const std::exception& exception) {
        error = std::current_exception();
        text = exception.what();
    }
    const std::lock_guard lock(mutex_);
    if (error) {
        refinement_.give_up(job.step);
    }
    error_ = std::move(error);
    error_text_ = std::move(text);
}

void Renderer::render(Session& session, const Job& job) {
    const Clock::time_point begin = Clock::now();
    Frame frame{.state = job.step.state, .divisor = job.step.divisor};
    std::optional<Image> pass = gather(session, job, frame);
    frame.seconds = seconds_between(begin, Clock::now());
    if (pass) {
        add_pass(job, frame, std::move(*pass));
    }
    // The frame and what is next change together, so that nobody waits for a frame that has come.
    const std::lock_guard lock(mutex_);
    refinement_.finish(job.step, pass.has_value(), seconds_between(begin, Clock::now()));
    if (pass) {
        if (!refinement_.next()) {
            frame.smoothed.reset();
        }
        frame_ = std::make_shared<const Frame>(std::move(frame));
    }
}

/// Renders the step's pass. Returns nothing if it was stopped.
std::optional<Image> Renderer::gather(Session& session, const Job& job, Frame& frame) {
    const RenderSettings& settings = job.settings;
    const Scene scene = *this->scene();
    const std::uint32_t seed = pass_seed(settings.seed, job.step);
    frame.view =
        session.look(pass_view(settings.view, scene.width(), scene.height(), job.step.divisor), seed);
    if (!vpls_ || vpls_change_ != job.sampling_change || makes_vpls(job.step)) {
        vpls_ = session.sample(*frame.view, settings.sampling, seed);
        vpls_change_ = job.sampling_change;
        lights_.reset();
    }
    frame.vpls = vpls_;
    Picture picture = session.gather(*frame.view, *vpls_, pass_gather(settings, job.step.kind), seed,
                                     [&](double) { return is_wanted(job.step); });
    if (picture.interrupted) {
        return std::nullopt;
    }
    return std::move(picture.image);
}

/// Puts the pass, or the mean with those before, into the frame.
void Renderer::add_pass(const Job& job, Frame& frame, Image&& pass) {
    if (job.step.kind == StepKind::refining) {
        mean_.add(pass);
        frame.image = mean_.image();
        frame.samples = mean_.passes();
    } else {
        frame.image = std::move(pass);
        if (job.step.kind == StepKind::full) {
            mean_.begin(frame.image);
        }
    }
    if (frame.samples < kUnsmoothedSamples) {
        frame.smoothed = frame.image;
        smooth_interleaved(*frame.smoothed, kInterleave);
    }
    if (job.step.kind == StepKind::reduced) {
        return;
    }
    if (!lights_) {
        lights_ = std::make_shared<const std::vector<VirtualPointLight>>(vpls_->lights());
    }
    frame.lights = lights_;
    if (job.step.kind == StepKind::full) {
        seconds_to_full_ = seconds_between(job.changed_at, Clock::now());
    }
    frame.seconds_to_full = seconds_to_full_;
}

bool Renderer::is_wanted(const Step& step) const {
    const std::lock_guard lock(mutex_);
    return !is_stopping_ && !refinement_.is_outdated(step);
}

}  // namespace nearlight::viewer
