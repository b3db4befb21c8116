// SPDX-License-Identifier: Apache-2.0
#include "host/cli/pass_options.h"

#include <algorithm>
#include <cmath>

#include "host/base/limits.h"
#include "host/cli/log.h"
#include "host/cli/pass_list.h"
#include "host/session/passes.h"
#include "host/session/splat_rows.h"

namespace nearlight::core {
namespace {

bool has_variance(const PictureOptions& picture) {
    return std::ranges::find(picture.layers, "variance") != picture.layers.end();
}

}  // namespace

void add_pass_options(CLI::App& command, PassOptions& options) {
    auto* const passes = command.add_option(
        "--passes", options.passes,
        "Number of renderings to average, each with different VPLs and random numbers (default: 1)");
    passes->check(CLI::Range(1u, kMaxPasses))->type_name("N");
    auto* const time = command.add_option(
        "--time", options.seconds,
        "Make as many passes as fit in this time, including the time to read the scene but not that to "
        "denoise the picture, the last with fewer samples; at least one of two samples per pixel, and never "
        "more than --passes");
    time->check(number_from(0.0, 1e9))->type_name("SECONDS");
    auto* const error = command.add_option(
        "--error", options.error,
        fmt::format(
            "Make passes until the picture's relative error is at most E: the root of the mean of "
            "variance / (b^2 + m^2/100), where b is the brightness around the pixel and m that of the "
            "picture, without the worst thousandth of the pixels; at most --passes, or {}",
            kMaxPassesToError));
    error->check(number_from(1e-5, 100.0))->type_name("E");
    command
        .add_option_function<std::string>(
            "--pass-spp",
            [&options](const std::string& text) { options.pass_samples = parse_pass_list(text); },
            "Samples per pixel of each pass, as in 16*3,7, which a picture's nearlight:passSpp states: makes "
            "the picture of a --time or --error again")
        ->type_name("LIST")
        ->excludes(passes, time, error);
}

void check_variance_is_known(const PictureOptions& picture, const RenderSettings& settings) {
    const uint samples = settings.gather.samples_per_pixel;
    const bool may_tell = settings.pass_samples.empty()
                              ? may_have_passes(settings) || tells_error({{samples}})
                              : tells_error(settings.pass_samples);
    if (has_variance(picture) && !may_tell) {
        throw Error(ErrorKind::invalid_argument,
                    "the layer variance needs two samples per pixel; use --spp 2 or --passes 2");
    }
}

void warn_of_unsplatted_passes(const RenderSettings& settings, const PixelFilter& filter) {
    const uint fewest = min_later_samples(settings.gather);
    const auto has_splats = [&](uint samples) { return samples >= fewest; };
    const bool are_mixed = std::ranges::any_of(settings.pass_samples, has_splats) &&
                           !std::ranges::all_of(settings.pass_samples, has_splats);
    if (are_mixed && splat_reach(filter, settings.gather) > 0) {
        spdlog::warn(
            "--pass-spp has passes of fewer than {} samples, which are noisier than their weight says",
            fewest);
    }
}

void warn_of_unknown_variance(const PictureOptions& picture, std::span<const uint> samples) {
    if (has_variance(picture) && !tells_error(samples)) {
        spdlog::warn("the layer variance is 0 and says nothing: the picture has one sample per pixel");
    }
}

void tell_forecast(const PassForecast& forecast, double target) {
    const std::string text =
        fmt::format("error {:.4f}; {:g} is expected after {:.0f} pass{}, {:.0f} s{}", forecast.error, target,
                    std::ceil(forecast.passes), forecast.passes > 1.0 ? "es" : "", forecast.seconds,
                    forecast.reaches ? "" : ", beyond the limits of passes and time");
    spdlog::info("{}", text);
}

void tell_limits(const PassOptions& options, const RenderReport& report, uint min_samples, double seconds) {
    if (const auto target = options.error; target && report.error) {
        const bool reached = *report.error <= *target;
        spdlog::info(
            "error {:.4f}{}", *report.error,
            reached || report.interrupted
                ? ""
                : fmt::format(
                      ", more than {:g}: {}", *target,
                      options.seconds && report.passes < options.passes.value_or(kMaxPassesToError)
                          ? "the time is used"
                          : fmt::format("the limit is {} passes; --passes sets another", report.passes)));
    }
    if (options.seconds && seconds > 1.1 * *options.seconds && report.passes == 1 &&
        report.pass_samples.front() == min_samples) {
        spdlog::warn("--time {:g} is shorter than {} samples per pixel take, the fewest that there are",
                     *options.seconds, report.pass_samples.front());
    }
}

}  // namespace nearlight::core
