// SPDX-License-Identifier: Apache-2.0
#include "host/cli/cuts_options.h"

#include <fmt/format.h>

#include "host/base/limits.h"
#include "host/samplers/sampler.h"

namespace nearlight::core {

void add_cuts_options(CLI::App& command, std::string& cuts, SamplingSettings& sampling) {
    add_words(
        command, "--cuts", {"on", "off", "auto"}, [&cuts](const std::string& word) { cuts = word; },
        "on: there are more VPLs than --vpls, and each small group of neighbouring samples (a "
        "bundle) asks those that could bring it most; off: there are as many as --vpls; "
        "auto: on with --vpl-set")
        ->default_str(cuts);
    command
        .add_option("--vpl-set", sampling.set_count,
                    "With --cuts, target number of VPLs in all, of which a pixel asks --vpls (default: "
                    "64 times --vpls, at most 2^20)")
        ->check(CLI::Range(1u, kMaxVpls))
        ->type_name("N");
}

bool has_cuts(const std::string& cuts, const RenderSettings& settings) {
    const SamplingSettings& sampling = settings.sampling;
    if (cuts == "off" && sampling.set_count) {
        throw Error(ErrorKind::invalid_argument, "--vpl-set needs --cuts on or auto, not off");
    }
    if (sampling.set_count && *sampling.set_count < sampling.vpl_count) {
        throw Error(
            ErrorKind::invalid_argument,
            fmt::format("--vpl-set {} is smaller than --vpls {}, which is what a pixel asks of the set",
                        *sampling.set_count, sampling.vpl_count));
    }
    const bool wanted = cuts == "on" || sampling.set_count;
    if (wanted && settings.gather.roulette > 0.0f) {
        throw Error(ErrorKind::invalid_argument, "--roulette cannot be combined with --cuts or --vpl-set");
    }
    if (wanted && sampler_entry(sampling.sampler).makes_local_lights) {
        throw Error(ErrorKind::invalid_argument,
                    "the sampler " + to_string(sampling.sampler) + " takes neither --cuts nor --vpl-set");
    }
    SamplingSettings with_cuts = sampling;
    with_cuts.cuts = wanted;
    if (sampling.close_fraction && sampling.policy == Policy::complete && with_cuts.asks_part()) {
        throw Error(
            ErrorKind::invalid_argument,
            "--close-fraction cannot be combined with --cuts or --vpl-set, because the policy complete "
            "then takes its VPLs from the whole scene alike");
    }
    return wanted;
}

}  // namespace nearlight::core
