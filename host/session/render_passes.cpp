// SPDX-License-Identifier: Apache-2.0
#include "host/session/render_passes.h"

#include <optional>
#include <utility>

#include "host/session/pass_average.h"
#include "host/session/passes.h"
#include "host/session/picture_window.h"
#include "host/session/render_steps.h"

namespace nearlight::core {
namespace {

/// The settings of pass `report.passes`. It keeps what the first pass decided about the view, because the
/// mean would otherwise mix different views.
RenderSettings pass_settings(RenderSettings settings, uint samples, const std::optional<Prepared>& first,
                             const RenderReport& report) {
    settings.seed = pass_seed(settings.seed, report.passes);
    if (first) {
        const RayBudget budget = budget_of(first->view, first->vpls, settings.gather);
        settings.view.range = first->view.close_range.range;
        settings.view.clamp_radius = budget.clamp_radius;
        settings.gather.direct_samples_per_pixel = budget.light_samples_per_pixel;
    }
    return with_samples(settings, samples);
}

/// The passes of a picture, and what they have become.
struct Passes {
    PassSchedule schedule;
    std::optional<Prepared> first;
    std::optional<PassAverage> average;
};

/// Makes a pass of `samples` per pixel. If it is the first and given up, nothing is left of it but its time.
void make_pass(Session& session, const RenderSettings& settings, uint samples, const GatherFraction& progress,
               Passes& passes, RenderReport& report) {
    const RenderReport before = report;
    Prepared pass = prepare(session, pass_settings(settings, samples, passes.first, report), report);
    passes.schedule.note_vpls();
    if (!passes.average) {
        const PixelWindow window = window_of(pass.view, pass.settings.gather);
        passes.average.emplace(window.width, window.height);
    }
    passes.average->begin_pass(samples);
    bool too_long = false;
    gather(
        session, pass, [&](std::span<const float> rows) { passes.average->add_rows(rows); },
        [&](double fraction) {
            too_long = too_long || passes.schedule.is_too_long(fraction);
            return !too_long && progress(passes.schedule.fraction(fraction));
        },
        report);
    if (too_long && report.interrupted) {
        const RenderSeconds seconds = report.seconds;
        report = before;
        report.seconds = seconds;
        passes.average.reset();
        return;
    }
    if (!report.interrupted) {
        passes.schedule.believe_after(passes.average->telling_passes());
        passes.schedule.end(settings.error ? std::optional(passes.average->error()) : std::nullopt);
    }
    if (!passes.first) {
        passes.first = std::move(pass);
    }
}

}  // namespace

void render_passes(Session& session, const RenderSettings& settings, const RenderStart& start,
                   const RowSink& sink, const GatherFraction& progress, const ForecastSink& forecast,
                   RenderReport& report) {
    Passes passes{.schedule = PassSchedule(settings, report.seconds.total), .first = {}, .average = {}};
    while (const std::optional<uint> samples = report.interrupted ? std::nullopt : passes.schedule.begin()) {
        if (const auto expected = passes.schedule.forecast(); expected && forecast) {
            forecast(*expected);
        }
        make_pass(session, settings, *samples, progress, passes, report);
    }
    if (settings.error && !passes.schedule.samples().empty()) {
        report.error = passes.average->error();
    }
    start(report, passes.first->view, passes.first->vpls);
    passes.average->send(sink);
}

}  // namespace nearlight::core
