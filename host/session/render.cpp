// SPDX-License-Identifier: Apache-2.0
#include "host/session/render.h"

#include <algorithm>
#include <utility>

#include "host/base/hash.h"
#include "host/base/stopwatch.h"
#include "host/session/camera_refinement.h"
#include "host/session/passes.h"
#include "host/session/render_passes.h"
#include "host/session/render_steps.h"
#include "host/session/splat_rows.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {
namespace {

RenderReport begin_report(Session& session) {
    RenderReport report;
    const SessionSeconds ready = session.take_seconds();
    report.seconds = {.build_bvh = ready.build_bvh, .upload = ready.upload, .total = ready.total};
    return report;
}

/// The mean of passes with the same VPLs would converge to a picture with their noise.
void refuse_passes_of_a_file(const RenderSettings& settings, bool has_passes) {
    if (!settings.sampling.file.empty() && has_passes) {
        throw Error(ErrorKind::invalid_argument,
                    "VPLs from a file would be the same in every pass: a picture of them has one pass, with "
                    "no limit of time or error and no checkpoint",
                    "file");
    }
}

/// Makes a picture of `samples` per pixel, which may be more or fewer than the settings say.
void render_once(Session& session, const RenderSettings& settings, uint samples, const RenderHooks& hooks,
                 RenderReport& report) {
    Prepared pass = prepare(session, with_samples(settings, samples), hooks.vpls);
    note_pass(settings, pass, report);
    scale_light_samples(settings, pass);
    hooks.open(report, pass.view, pass.vpls);
    gather(session, pass, hooks.rows, hooks.progress, report);
}

}  // namespace

bool has_splats(const RenderReport& report, const GatherSettings& settings) {
    return std::ranges::any_of(report.pass_samples, [&](uint samples) {
        return splat_reach(report.filter, with_samples({.gather = settings}, samples).gather) > 0;
    });
}

bool has_refinement(const RenderReport& report, const GatherSettings& settings) {
    return std::ranges::any_of(report.pass_samples, [&](uint samples) {
        return may_refine(with_samples({.gather = settings}, samples).gather);
    });
}

bool averages_passes(const RenderSettings& settings, const PassStart& pass_start) {
    return may_have_passes(settings) || !pass_start.is_plain();
}

void add_beauty(std::span<const float> rows, Hasher& hasher) {
    for (std::size_t i = 0; i < rows.size(); i += NEARLIGHT_LAYER_CHANNELS) {
        hasher.add_bytes(std::as_bytes(rows.subspan(i + NEARLIGHT_LAYER_BEAUTY, NEARLIGHT_CHANNELS_RGB)));
    }
}

RenderReport render(Session& session, const RenderSettings& settings, const RenderHooks& hooks,
                    PassStart pass_start) {
    const bool has_passes = averages_passes(settings, pass_start);
    refuse_passes_of_a_file(settings, has_passes);
    RenderReport report = begin_report(session);
    const Stopwatch total;
    Hasher hasher;
    RenderHooks hashing = hooks;
    hashing.rows = [&](std::span<const float> rows) {
        add_beauty(rows, hasher);
        hooks.rows(rows);
    };
    if (has_passes) {
        render_passes(session, settings, hashing, std::move(pass_start), report);
    } else {
        const uint samples =
            settings.pass_samples.empty() ? settings.gather.samples_per_pixel : settings.pass_samples.front();
        render_once(session, settings, samples, hashing, report);
    }
    report.image_hash = hasher.hash64();
    report.seconds.compile = session.new_compile_seconds();
    report.seconds.total += total.seconds();
    return report;
}

}  // namespace nearlight::core
