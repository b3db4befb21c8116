// SPDX-License-Identifier: Apache-2.0
#include "host/session/render_steps.h"

#include <algorithm>
#include <utility>

#include "host/base/stopwatch.h"
#include "host/session/passes.h"
#include "host/session/picture_window.h"

namespace nearlight::core {
namespace {

void note_view(const View& view, RenderReport& report) {
    report.range = view.close_range.range;
    report.max_depth = view.max_depth;
    report.filter = view.scene_camera.filter;
}

/// The settings of the view, without a pilot that has nothing to decide, as in all passes but the first.
ViewSettings view_settings(const RenderSettings& settings) {
    ViewSettings view = settings.view;
    const GatherSettings& gather = settings.gather;
    const bool is_decided = view.clamp_radius && gather.direct_samples_per_pixel && gather.shared_limit;
    view.ray_budget_pilot = view.ray_budget_pilot && !is_decided;
    return view;
}

}  // namespace

View look(Session& session, const RenderSettings& settings, RenderReport& report) {
    const Stopwatch watch;
    View view = session.look(view_settings(settings), settings.seed);
    note_view(view, report);
    report.seconds.generate += watch.seconds();
    return view;
}

void note_pass(const RenderSettings& whole, const Prepared& pass, RenderReport& report) {
    if (report.passes++ == 0) {
        const PixelWindow window = window_of(pass.view, pass.settings.gather);
        report.width = static_cast<int>(window.width);
        report.height = static_cast<int>(window.height);
        note_view(pass.view, report);
        report.ray_budget = budget_of(pass.view, pass.vpls, whole.gather);
        report.close_fraction = pass.vpls.close_fraction;
        report.asked_count = pass.vpls.asked_count;
    }
    report.pass_samples.push_back(pass.settings.gather.samples_per_pixel);
    report.totals.close_vpls += pass.vpls.close_count;
    report.totals.distant_vpls += pass.vpls.distant_count;
    report.totals.sparse_vpls += pass.vpls.sparse_count;
    report.totals.candidates += pass.vpls.candidate_count;
    report.seconds.generate += pass.seconds;
}

Prepared prepare(Session& session, const RenderSettings& settings, const VplMaker& vpls) {
    const Stopwatch watch;
    const ViewSettings view = view_settings(settings);
    Prepared pass{.view = session.look(view, settings.seed), .vpls = {}, .settings = settings};
    pass.vpls = vpls ? vpls(view, settings.sampling, settings.seed)
                     : session.sample(pass.view, settings.sampling, settings.seed);
    pass.seconds = watch.seconds();
    return pass;
}

void scale_light_samples(const RenderSettings& whole, Prepared& pass) {
    RenderSettings decided = whole;
    decided.gather.direct_samples_per_pixel =
        budget_of(pass.view, pass.vpls, whole.gather).direct_samples_per_pixel;
    GatherSettings& gather = pass.settings.gather;
    gather.direct_samples_per_pixel =
        with_samples(std::move(decided), gather.samples_per_pixel).gather.direct_samples_per_pixel;
}

void gather(Session& session, const Prepared& pass, const RowSink& sink, const WorkProgress& progress,
            RenderReport& report, std::function<std::shared_ptr<PlannedPicture>()> next) {
    const Stopwatch watch;
    const GatherOutcome outcome =
        session.gather(pass.view, pass.vpls, pass.settings.gather, pass.settings.seed, sink, progress,
                       {.present = pass.planned, .next = std::move(next)});
    report.seconds.gather += watch.seconds();
    report.totals.local_lights += outcome.local_lights;
    report.interrupted = outcome.interrupted;
    report.device_bytes = std::max(report.device_bytes, session.peak_bytes());
    add_shares(outcome.shares, report.shares);
}

}  // namespace nearlight::core
