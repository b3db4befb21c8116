// SPDX-License-Identifier: Apache-2.0
#include "host/session/render.h"

#include <algorithm>

#include "host/base/hash.h"
#include "host/base/stopwatch.h"
#include "host/session/passes.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

/// The products of look and sample, which a gather needs.
struct Prepared {
    View view;
    VplSet vpls;
    uint seed = 0;
};

void add_beauty(std::span<const float> rows, Hasher& hasher) {
    for (std::size_t i = 0; i < rows.size(); i += NEARLIGHT_LAYER_CHANNELS) {
        hasher.add_bytes(std::as_bytes(rows.subspan(i + NEARLIGHT_LAYER_BEAUTY, NEARLIGHT_CHANNELS_RGB)));
    }
}

RenderReport begin_report(Session& session) {
    RenderReport report;
    const SessionSeconds ready = session.take_seconds();
    report.seconds = {.build_bvh = ready.build_bvh, .upload = ready.upload, .total = ready.total};
    return report;
}

/// Adds a pass to the report: the settings that were decided, and the number of VPLs.
void note_pass(const Prepared& pass, const GatherSettings& settings, RenderReport& report) {
    if (report.passes++ == 0) {
        report.width = static_cast<int>(pass.view.camera.width);
        report.height = static_cast<int>(pass.view.camera.height);
        report.range = pass.view.close_range.range;
        report.ray_budget = budget_of(pass.view, pass.vpls, settings);
        report.max_depth = pass.view.max_depth;
        report.filter = pass.view.scene_camera.filter.kind;
        report.close_fraction = pass.vpls.close_fraction;
    }
    report.close_vpls += pass.vpls.close_count;
    report.distant_vpls += pass.vpls.distant_count;
    report.sparse_vpls += pass.vpls.sparse_count;
    report.candidates += pass.vpls.candidate_count;
}

Prepared prepare(Session& session, const RenderSettings& settings, uint seed, RenderReport& report) {
    const Stopwatch watch;
    Prepared pass{.view = session.look(settings.view, seed), .vpls = {}, .seed = seed};
    pass.vpls = session.sample(pass.view, settings.sampling, seed);
    note_pass(pass, settings.gather, report);
    report.seconds.generate += watch.seconds();
    return pass;
}

void gather(Session& session, const Prepared& pass, const GatherSettings& settings, const RowSink& sink,
            const GatherFraction& progress, RenderReport& report) {
    const Stopwatch watch;
    const GatherOutcome outcome = session.gather(pass.view, pass.vpls, settings, pass.seed, sink, progress);
    report.seconds.gather += watch.seconds();
    report.local_lights += outcome.local_lights;
    report.interrupted = outcome.interrupted;
    report.device_bytes = std::max(report.device_bytes, session.peak_bytes());
    add_shares(outcome.shares, report.shares);
}

/// Settings for later passes. They keep what the first pass decided about the view, because the mean would
/// otherwise mix different views.
RenderSettings decided(const RenderSettings& settings, const Prepared& first) {
    const RayBudget budget = budget_of(first.view, first.vpls, settings.gather);
    RenderSettings same = settings;
    same.view.range = first.view.close_range.range;
    same.view.clamp_radius = budget.clamp_radius;
    same.gather.direct_samples_per_pixel = budget.light_samples_per_pixel;
    return same;
}

void render_once(Session& session, const RenderSettings& settings, const RenderStart& start,
                 const RowSink& sink, const GatherFraction& progress, RenderReport& report) {
    const Prepared pass = prepare(session, settings, settings.seed, report);
    start(report, pass.view, pass.vpls);
    gather(session, pass, settings.gather, sink, progress, report);
}

void render_passes(Session& session, const RenderSettings& settings, const RenderStart& start,
                   const RowSink& sink, const GatherFraction& progress, RenderReport& report) {
    PassClock clock(settings, report.seconds.total);
    const Prepared first = prepare(session, settings, settings.seed, report);
    PassAverage average(first.view.camera.width, first.view.camera.height);
    const RowSink add_rows = [&](std::span<const float> rows) { average.add_rows(rows); };
    const GatherFraction pass_progress = [&](double fraction) { return progress(clock.fraction(fraction)); };
    gather(session, first, settings.gather, add_rows, pass_progress, report);
    const RenderSettings same = decided(settings, first);
    while (!report.interrupted && clock.has_another()) {
        average.begin_pass();
        const Prepared pass = prepare(session, same, pass_seed(settings.seed, report.passes), report);
        gather(session, pass, same.gather, add_rows, pass_progress, report);
    }
    start(report, first.view, first.vpls);
    average.send(sink);
}

}  // namespace

RenderReport render(Session& session, const RenderSettings& settings, const RenderStart& start,
                    const RowSink& sink, const RenderProgress& progress) {
    RenderReport report = begin_report(session);
    const Stopwatch total;
    Hasher hasher;
    const RowSink hash_and_send = [&](std::span<const float> rows) {
        add_beauty(rows, hasher);
        sink(rows);
    };
    const GatherFraction gathering = [&](double fraction) { return progress("gathering", fraction); };
    const bool several = settings.passes.value_or(settings.seconds ? 2 : 1) > 1;
    (several ? render_passes : render_once)(session, settings, start, hash_and_send, gathering, report);
    report.image_hash = hasher.hash64();
    report.seconds.compile = session.new_compile_seconds();
    report.seconds.total += total.seconds();
    return report;
}

}  // namespace nearlight::core
