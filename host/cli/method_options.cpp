// SPDX-License-Identifier: Apache-2.0
#include "host/cli/method_options.h"

#include <cmath>

#include "host/base/limits.h"
#include "host/cli/cuts_options.h"
#include "host/samplers/sampler.h"

namespace nearlight::core {
namespace {

/// Adds an option that chooses an entry of a table, whose names and descriptions its help lists.
template <typename Choice, typename Value, typename Entries, typename Entry>
CLI::Option* add_described_choice(CLI::App& command, const char* option, Value& value, const Entries& entries,
                                  Choice Entry::*entry_choice, std::string help) {
    std::map<std::string, Choice> choices;
    for (const Entry& entry : entries) {
        help += fmt::format("{}{} ({})", choices.empty() ? "" : ", ", entry.name, entry.description);
        choices.emplace(entry.name, entry.*entry_choice);
    }
    return add_choice(command, option, value, choices, help);
}

/// The sampler close-range alone has policies and a fraction of VPLs in the close range.
void check_is_close_range(const MethodTexts& texts, const SamplingSettings& sampling) {
    if (sampling.sampler == SamplerKind::close_range) {
        return;
    }
    const char* const option = texts.policy                     ? "--policy"
                               : texts.close_fraction != "auto" ? "--close-fraction"
                                                                : nullptr;
    if (option != nullptr) {
        throw Error(ErrorKind::invalid_argument, fmt::format("{} is for the sampler close-range, not for {}",
                                                             option, to_string(sampling.sampler)));
    }
}

}  // namespace

void add_sample_options(CLI::App& command, GatherSettings& gather, Pilot pilot) {
    command.add_option("--spp", gather.samples_per_pixel, "Camera samples per pixel, for antialiasing")
        ->check(CLI::Range(1u, kMaxSamplesPerPixel))
        ->type_name("N")
        ->capture_default_str();
    command
        .add_option(
            "--direct-samples", gather.direct_samples_per_pixel,
            fmt::format("Shadow rays per pixel to area lights, the environment and the sun, and to point "
                        "lights if there are many (default: {})",
                        pilot == Pilot::runs ? "16 to 128, chosen by a pilot" : "32"))
        ->check(CLI::Range(1u, kMaxLightSamples))
        ->type_name("N");
}

void add_sampler_options(CLI::App& command, RenderSettings& settings, MethodTexts& texts) {
    SamplingSettings& sampling = settings.sampling;
    add_described_choice(command, "--sampler", sampling.sampler, all_samplers(), &SamplerEntry::kind,
                         "Where to put VPLs: ")
        ->default_str(to_string(sampling.sampler));
    add_described_choice(command, "--policy", texts.policy, all_policies(), &PolicyEntry::policy,
                         "Policy of the sampler close-range: ")
        ->default_str(to_string(sampling.policy));
    command
        .add_option("--vpls", sampling.vpl_count,
                    "Target number of VPLs (virtual point lights) that the samples of a pixel ask together")
        ->check(CLI::Range(0u, kMaxVpls))
        ->type_name("N")
        ->capture_default_str();
    add_cuts_options(command, texts.cuts, sampling);
    command
        .add_option("--close-fraction", texts.close_fraction,
                    "Fraction of the VPLs that lie in the close range: 0 to 1, or auto")
        ->type_name("F")
        ->capture_default_str();
}

void add_refine_option(CLI::App& command, GatherSettings& gather) {
    add_words(
        command, "--refine", {"on", "off"},
        [&gather](const std::string& word) { gather.refine = word == "on"; },
        "on: pixels at edges of windows and lamps, of their images in mirrors, and of highlights get up "
        "to 8 times the camera paths of others, for light that needs no VPLs; off: all have the same "
        "number")
        ->default_str("on");
}

void add_splat_option(CLI::App& command, std::string& splat) {
    add_words(
        command, "--splat", {"on", "off"}, [&splat](const std::string& word) { splat = word; },
        "on: samples count in all pixels whose reconstruction filter reaches them, which leaves "
        "about a half to a third of the variance; off: in their own pixel alone, so that pixels have "
        "noise of their own, as denoisers expect (default: on, but off with --denoise and with layers "
        "of mattes)");
}

void add_method_options(CLI::App& command, RenderSettings& settings, MethodTexts& texts, Pilot pilot) {
    command
        .add_option("--range", texts.range,
                    "Distance from the camera at which the close range ends: in m, or auto")
        ->type_name("R")
        ->capture_default_str();
    command
        .add_option(
            "--clamp-radius", texts.clamp_radius,
            fmt::format("VPLs closer than R light a point as if they were at the distance R, and rays "
                        "bring back the rest: in m, or auto, which {}",
                        pilot == Pilot::runs ? "chooses the radius of least noise at the default --rays"
                                             : "is a twentieth of the range"))
        ->type_name("R")
        ->capture_default_str();
    add_words(
        command, "--compensate", {"on", "off"},
        [&settings](const std::string& word) { settings.gather.compensate = word == "on"; },
        "on: rays bring back the light that the clamp radius takes away and what surfaces reflect other "
        "than diffusely, so that the picture is the scene's own; off: the clamped picture of the VPLs")
        ->default_str("on");
    command
        .add_option("--rays", settings.gather.rays_per_pixel,
                    "Rays per pixel for what --compensate brings back, and as many that look for lamps and "
                    "windows in rough reflections")
        ->check(CLI::Range(1u, kMaxLightSamples))
        ->type_name("N")
        ->capture_default_str();
    command
        .add_option("--max-depth", settings.view.max_depth,
                    "Maximum path depth, counted as in Mitsuba: 2 is direct light only (default: the "
                    "scene's, or 256)")
        ->check(CLI::Range(1u, kMaxPathDepth))
        ->type_name("N");
    add_seed_option(command, settings.seed);
    command
        .add_option("--roulette", settings.gather.roulette,
                    "Russian roulette: trace a VPL that could bring less than T times the mean only with a "
                    "probability; 0 traces all")
        ->check(number_from(0, 1000))
        ->type_name("T")
        ->capture_default_str();
}

void settle(const MethodTexts& texts, RenderSettings& settings) {
    check_is_close_range(texts, settings.sampling);
    settings.sampling.policy = texts.policy.value_or(settings.sampling.policy);
    settings.sampling.close_fraction = number_or_auto("--close-fraction", texts.close_fraction, 0.0f, 1.0f);
    settings.view.range = number_or_auto("--range", texts.range, 1e-6f, kMaxLength);
    settings.view.clamp_radius = number_or_auto("--clamp-radius", texts.clamp_radius, 0.0f, kMaxLength);
    settings.sampling.cuts = has_cuts(texts.cuts, settings);
    if (settings.gather.roulette > 0.0f && sampler_entry(settings.sampling.sampler).makes_local_lights) {
        throw Error(ErrorKind::invalid_argument,
                    "the sampler " + to_string(settings.sampling.sampler) + " takes no --roulette");
    }
}

}  // namespace nearlight::core
