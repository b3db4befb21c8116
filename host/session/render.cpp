// SPDX-License-Identifier: Apache-2.0
#include "host/session/render.h"

#include <utility>

#include "host/base/hash.h"
#include "host/base/stopwatch.h"
#include "host/session/passes.h"
#include "host/session/render_passes.h"
#include "host/session/render_steps.h"
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
void refuse_passes_of_a_file(const RenderSettings& settings, bool keeps_sums) {
    if (!settings.sampling.file.empty() && keeps_sums) {
        throw Error(ErrorKind::invalid_argument,
                    "VPLs from a file would be the same in every pass: a picture of them has one pass, with "
                    "no limit of time or error and no checkpoint",
                    "file");
    }
}

void render_once(Session& session, const RenderSettings& settings, const RenderHooks& hooks,
                 RenderReport& report) {
    const Prepared pass = prepare(session, settings, hooks.vpls, report);
    hooks.start(report, pass.view, pass.vpls);
    gather(session, pass, hooks.rows, hooks.progress, report);
}

}  // namespace

void add_beauty(std::span<const float> rows, Hasher& hasher) {
    for (std::size_t i = 0; i < rows.size(); i += NEARLIGHT_LAYER_CHANNELS) {
        hasher.add_bytes(std::as_bytes(rows.subspan(i + NEARLIGHT_LAYER_BEAUTY, NEARLIGHT_CHANNELS_RGB)));
    }
}

RenderReport render(Session& session, const RenderSettings& settings, const RenderHooks& hooks,
                    PassStart pass_start) {
    const bool keeps_sums = may_have_passes(settings) || !pass_start.is_plain();
    refuse_passes_of_a_file(settings, keeps_sums);
    RenderReport report = begin_report(session);
    const Stopwatch total;
    Hasher hasher;
    RenderHooks hashing = hooks;
    hashing.rows = [&](std::span<const float> rows) {
        add_beauty(rows, hasher);
        hooks.rows(rows);
    };
    if (keeps_sums) {
        render_passes(session, settings, hashing, std::move(pass_start), report);
    } else {
        const uint samples =
            settings.pass_samples.empty() ? settings.gather.samples_per_pixel : settings.pass_samples.front();
        render_once(session, with_samples(settings, samples), hashing, report);
    }
    report.image_hash = hasher.hash64();
    report.seconds.compile = session.new_compile_seconds();
    report.seconds.total += total.seconds();
    return report;
}

}  // namespace nearlight::core
