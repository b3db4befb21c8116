// SPDX-License-Identifier: Apache-2.0
#include "host/session/render_passes.h"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "host/base/message.h"
#include "host/session/passes.h"
#include "host/session/picture_window.h"
#include "host/session/render_steps.h"

namespace nearlight::core {
namespace {

using Moment = PassesSoFar::Moment;

/// The passes of a picture, and what they have become.
struct Passes {
    PassSchedule schedule;
    uint first = 0;                      ///< number of the first pass; those before it are made elsewhere
    std::optional<PassChoice> choice{};  ///< what pass 0 decided for all passes
    /// The view of the first pass that is made here; after a checkpoint with whole passes, a view as pass 0
    /// has it.
    std::optional<View> view{};
    VplSet vpls{};  ///< the VPLs of the same pass; none after a checkpoint with whole passes
    std::optional<PassAverage> average{};
    std::size_t begun_rows = 0;  ///< rows that a checkpoint has of a pass it left unfinished
    PassTotals totals{};         ///< counts over all whole passes
    /// The pass after the present one, if remote devices may begin it early.
    std::optional<Prepared> next{};
};

PassChoice choice_of(const Prepared& pass, const RenderSettings& settings) {
    return {.range = pass.view.close_range.range,
            .ray_budget = budget_of(pass.view, pass.vpls, settings.gather)};
}

/// Passes keep what pass 0 decided about the view, because the mean would otherwise mix different views.
RenderSettings with_choice(RenderSettings settings, const PassChoice& choice) {
    settings.view.range = choice.range;
    settings.view.clamp_radius = choice.ray_budget.clamp_radius;
    settings.gather.direct_samples_per_pixel = choice.ray_budget.direct_samples_per_pixel;
    settings.gather.shared_limit = choice.ray_budget.shared_limit;
    return settings;
}

/// The settings of pass `number`.
RenderSettings pass_settings(const RenderSettings& settings, uint number, uint samples,
                             const std::optional<PassChoice>& choice) {
    RenderSettings result = choice ? with_choice(settings, *choice) : settings;
    result.seed = pass_seed(settings.seed, number);
    result.gather.spread_single_samples = true;
    return with_samples(std::move(result), samples);
}

/// The picture's relative error after passes of so many samples, if they tell it.
std::optional<double> known_error(const RenderSettings& settings, const Passes& passes,
                                  std::span<const uint> samples) {
    return settings.error && tells_error(samples) ? std::optional(passes.average->error()) : std::nullopt;
}

/// A pass that was begun is ended whatever the time, because its samples would else be lost.
void warn_of_long_rest(const RenderSettings& settings, const PassRecord& record, double rest) {
    const double seconds = rest * record.begun_samples * record.pace.sample_seconds.value_or(0.0);
    if (settings.seconds && seconds > *settings.seconds) {
        say_warning("the pass that the checkpoint left unfinished takes about " +
                    std::to_string(std::lround(seconds)) + " s more, longer than the time that is given");
    }
}

/// Goes on from a checkpoint.
void resume(Session& session, const RenderSettings& settings, Checkpoint checkpoint, Passes& passes,
            RenderReport& report) {
    const PassRecord& record = checkpoint.record;
    const std::vector<uint>& samples = record.whole.front().samples;
    const auto height = static_cast<double>(checkpoint.sums.height());
    report.width = static_cast<int>(checkpoint.sums.width());
    report.height = static_cast<int>(checkpoint.sums.height());
    report.passes = static_cast<uint>(samples.size());
    report.pass_samples = samples;
    report.close_fraction = record.close_fraction;
    report.totals = record.totals;
    passes.totals = record.totals;
    passes.choice = record.choice;
    passes.begun_rows = record.begun_rows;
    passes.average.emplace(std::move(checkpoint.sums), record.begun_samples, record.begun_rows);
    passes.schedule.believe_after(passes.average->telling_passes());
    warn_of_long_rest(settings, record, 1.0 - record.begun_rows / height);
    passes.schedule.resume(samples,
                           record.begun_rows == 0 ? known_error(settings, passes, samples) : std::nullopt,
                           record.pace, record.begun_samples, record.begun_rows / height);
    if (record.choice && !samples.empty()) {
        passes.view = look(session, with_choice(settings, *record.choice), report);
        report.ray_budget = record.choice->ray_budget;
    }
}

Passes begin_passes(Session& session, const RenderSettings& settings, const VplMaker& vpls, PassStart start,
                    RenderReport& report) {
    Passes passes{.schedule = PassSchedule(settings), .first = start.first};
    if (start.checkpoint) {
        resume(session, settings, std::move(*start.checkpoint), passes, report);
    }
    if (passes.first > 0 && !passes.choice) {
        // Pass 0 is taken to have all samples of a pass, as it has without a time or --pass-spp.
        const Prepared pass_0 = prepare(session, settings, vpls);
        passes.choice = choice_of(pass_0, settings);
        report.seconds.generate += pass_0.seconds;
    }
    return passes;
}

PassRecord record_of(const Passes& passes, uint seed, const RenderReport& report) {
    const std::size_t rows = passes.average->begun_rows();
    const bool is_begun = report.pass_samples.size() > passes.schedule.samples().size() && rows > 0;
    return {.whole = {{.seed = seed, .first = passes.first, .samples = passes.schedule.samples()}},
            .begun_samples = is_begun ? report.pass_samples.back() : 0,
            .begun_rows = is_begun ? static_cast<uint>(rows) : 0,
            .choice = passes.choice,
            .close_fraction = report.close_fraction,
            .totals = passes.totals,
            .pace = passes.schedule.pace()};
}

void tell(const PassWatcher& watcher, Moment moment, const Passes& passes, const View& view, uint seed,
          const RenderReport& report) {
    if (watcher) {
        watcher({.moment = moment,
                 .report = report,
                 .view = passes.view ? *passes.view : view,
                 .average = *passes.average,
                 .record = [&] { return record_of(passes, seed, report); }});
    }
}

/// The part of the picture that a pass has yet to make, after the rows from a checkpoint.
PixelWindow rest_of(const Prepared& pass, std::size_t begun_rows) {
    PixelWindow window = window_of(pass.view, pass.settings.gather);
    window.y += static_cast<uint>(begun_rows);
    window.height -= static_cast<uint>(begun_rows);
    return window;
}

/// Ends a pass after its last row.
void end_pass(const RenderSettings& settings, const Prepared& pass, Passes& passes,
              const RenderReport& report) {
    passes.schedule.believe_after(passes.average->telling_passes());
    std::vector<uint> samples = passes.schedule.samples();
    samples.push_back(pass.settings.gather.samples_per_pixel);
    passes.schedule.end(known_error(settings, passes, samples));
    passes.totals = report.totals;
    if (!passes.choice) {
        passes.choice = choice_of(pass, settings);
    }
}

/// Prepares a pass. It has the budget that pass 0 chose, if there is a choice.
Prepared prepare_pass(Session& session, const RenderSettings& settings,
                      const std::optional<PassChoice>& choice, const VplMaker& vpls) {
    Prepared pass = prepare(session, settings, vpls);
    if (choice) {
        pass.vpls.ray_budget = choice->ray_budget;
    }
    return pass;
}

/// What prepares and plans the pass after the present one while that is gathered; null if there is nobody who
/// could begin with it, or if it is not certain yet.
std::function<std::shared_ptr<PlannedPicture>()> preparation(Session& session, const RenderSettings& settings,
                                                             const VplMaker& vpls, const Prepared& present,
                                                             uint number, Passes& passes) {
    const uint samples = passes.schedule.sure_next_samples();
    if (samples == 0 || !session.looks_ahead()) {
        return {};
    }
    const PassChoice choice = passes.choice ? *passes.choice : choice_of(present, settings);
    return [&session, &vpls, &passes, choice, wanted = pass_settings(settings, number + 1, samples, choice)] {
        passes.next = prepare_pass(session, wanted, choice, vpls);
        passes.next->planned = session.plan(passes.next->view, passes.next->vpls, wanted.gather, wanted.seed);
        return passes.next->planned;
    };
}

/// Prepares a pass of `samples` per pixel, unless that was done already.
Prepared begin_pass(Session& session, const RenderSettings& settings, uint number, uint samples,
                    const VplMaker& vpls, Passes& passes, RenderReport& report) {
    std::optional<Prepared> ready = std::exchange(passes.next, std::nullopt);
    Prepared pass = ready ? std::move(*ready)
                          : prepare_pass(session, pass_settings(settings, number, samples, passes.choice),
                                         passes.choice, vpls);
    note_pass(settings, pass, report);
    if (!passes.choice) {
        scale_light_samples(settings, pass);
    }
    return pass;
}

/// Begins the sums of a pass. If a checkpoint has its first rows, the pass is to make only the others.
void begin_sums(Prepared& pass, uint samples, const PixelWindow& whole, Passes& passes) {
    if (passes.begun_rows > 0) {
        pass.settings.gather.window = rest_of(pass, std::exchange(passes.begun_rows, 0));
        return;
    }
    if (!passes.average) {
        passes.average.emplace(whole.width, whole.height);
    }
    passes.average->begin_pass(samples);
}

/// Leaves nothing of the first pass but its time; the report is as it was `before`.
void give_up(const RenderReport& before, Passes& passes, RenderReport& report) {
    const RenderSeconds seconds = report.seconds;
    report = before;
    report.seconds = seconds;
    passes.average.reset();
}

/// Makes a pass of `samples` per pixel. The first is given up if it turns out to take too long.
void make_pass(Session& session, const RenderSettings& settings, uint samples, const RenderHooks& hooks,
               Passes& passes, RenderReport& report) {
    const RenderReport before = report;
    const uint number = passes.first + report.passes;
    Prepared pass = begin_pass(session, settings, number, samples, hooks.vpls, passes, report);
    passes.schedule.note_vpls(pass.vpls.seconds_unless_kept);
    const PixelWindow whole = window_of(pass.view, pass.settings.gather);
    begin_sums(pass, samples, whole, passes);
    bool too_long = false;
    const auto take_rows = [&](std::span<const float> rows) {
        passes.average->add_rows(rows);
        if (passes.average->begun_rows() < whole.height) {
            tell(hooks.watcher, Moment::within_pass, passes, pass.view, settings.seed, report);
        }
    };
    const auto go_on = [&](double fraction) {
        too_long = too_long || passes.schedule.is_too_long(fraction);
        return !too_long && hooks.progress(passes.schedule.fraction(fraction));
    };
    gather(session, pass, take_rows, go_on, report,
           preparation(session, settings, hooks.vpls, pass, number, passes));
    if (too_long && report.interrupted) {
        give_up(before, passes, report);
        return;
    }
    if (passes.average->begun_rows() == whole.height) {
        end_pass(settings, pass, passes, report);
        tell(hooks.watcher, Moment::between_passes, passes, pass.view, settings.seed, report);
    }
    if (!passes.view) {
        passes.view = std::move(pass.view);
        passes.vpls = std::move(pass.vpls);
    }
}

}  // namespace

void render_passes(Session& session, const RenderSettings& settings, const RenderHooks& hooks,
                   PassStart start, RenderReport& report) {
    Passes passes = begin_passes(session, settings, hooks.vpls, std::move(start), report);
    while (const std::optional<uint> samples = report.interrupted ? std::nullopt : passes.schedule.begin()) {
        if (const auto expected = passes.schedule.forecast(); expected && hooks.forecast) {
            hooks.forecast(*expected);
        }
        make_pass(session, settings, *samples, hooks, passes, report);
    }
    report.error = known_error(settings, passes, passes.schedule.samples());
    tell(hooks.watcher, Moment::end, passes, *passes.view, settings.seed, report);
    hooks.open(report, *passes.view, passes.vpls);
    if (!passes.schedule.samples().empty() || passes.average->begun_rows() > 0) {
        passes.average->send(hooks.rows);
    }
}

}  // namespace nearlight::core
