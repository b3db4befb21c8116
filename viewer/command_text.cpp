// SPDX-License-Identifier: Apache-2.0
#include "viewer/command_text.h"

#include <charconv>

#include "host/base/shell_word.h"

namespace nearlight::viewer {
namespace {

/// The shortest text that reads back as the same number.
template <typename Number>
std::string text_of(Number value) {
    char text[64];
    const std::to_chars_result end = std::to_chars(std::begin(text), std::end(text), value);
    return {text, end.ptr};
}

std::string text_of(Vec3 v) {
    return text_of(v.x) + "," + text_of(v.y) + "," + text_of(v.z);
}

void add_camera(std::string& line, const CameraPose& camera) {
    line += " --origin=" + text_of(camera.origin) + " --target=" + text_of(camera.target);
    if (camera.up) {
        line += " --up=" + text_of(*camera.up);
    }
    if (camera.fov_x_degrees) {
        line += " --fov " + text_of(*camera.fov_x_degrees);
    }
}

/// Adds the option if the value is there, or differs from the default.
template <typename Number>
void add_option(std::string& line, const char* option, const std::optional<Number>& value) {
    if (value) {
        line += std::string(" ") + option + " " + text_of(*value);
    }
}
template <typename Number>
void add_option(std::string& line, const char* option, Number value, Number otherwise) {
    if (value != otherwise) {
        line += std::string(" ") + option + " " + text_of(value);
    }
}

void add_view(std::string& line, const ViewSettings& view) {
    if (view.camera) {
        add_camera(line, *view.camera);
    }
    if (view.width && view.height) {
        line += " --size " + std::to_string(*view.width) + "x" + std::to_string(*view.height);
    }
    add_option(line, "--range", view.range);
    add_option(line, "--clamp-radius", view.clamp_radius);
    add_option(line, "--max-depth", view.max_depth);
}

void add_sampling(std::string& line, const SamplingSettings& sampling) {
    const SamplingSettings otherwise;
    if (sampling.sampler != otherwise.sampler) {
        line += std::string(" --sampler ") + name_of(sampling.sampler);
    }
    // Other samplers ignore these two, as `complete` ignores the fraction with cuts, but their options would
    // be an error.
    if (sampling.sampler == SamplerKind::close_range) {
        if (sampling.policy != otherwise.policy) {
            line += std::string(" --policy ") + name_of(sampling.policy);
        }
        if (!(sampling.policy == Policy::complete && sampling.asks_part())) {
            add_option(line, "--close-fraction", sampling.close_fraction);
        }
    }
    add_option(line, "--vpls", sampling.vpl_count, otherwise.vpl_count);
    // The sampler `local` ignores cuts, but their options would be an error.
    if (sampling.cuts && sampling.sampler != SamplerKind::local) {
        line += " --cuts on";
        add_option(line, "--vpl-set", sampling.set_count);
    }
}

void add_gather(std::string& line, const GatherSettings& gather, SamplerKind sampler) {
    const GatherSettings otherwise;
    add_option(line, "--spp", gather.samples_per_pixel, otherwise.samples_per_pixel);
    add_option(line, "--direct-samples", gather.direct_samples_per_pixel);
    add_option(line, "--rays", gather.rays_per_pixel, otherwise.rays_per_pixel);
    if (!gather.compensate) {
        line += " --compensate off";
    }
    if (sampler != SamplerKind::local) {
        add_option(line, "--roulette", gather.roulette, otherwise.roulette);
    }
}

}  // namespace

const char* name_of(SamplerKind sampler) {
    switch (sampler) {
        case SamplerKind::close_range:
            return "close-range";
        case SamplerKind::instant_radiosity:
            return "instant-radiosity";
        case SamplerKind::rejection:
            return "rejection";
        case SamplerKind::metropolis:
            return "metropolis";
        case SamplerKind::bidirectional:
            return "bidirectional";
        case SamplerKind::local:
            return "local";
    }
    return "";
}

const char* name_of(Policy policy) {
    switch (policy) {
        case Policy::complete:
            return "complete";
        case Policy::paper:
            return "paper";
        case Policy::partition:
            return "partition";
    }
    return "";
}

const char* name_of(ToneCurve curve) {
    switch (curve) {
        case ToneCurve::linear:
            return "linear";
        case ToneCurve::neutral:
            return "neutral";
        case ToneCurve::agx:
            return "agx";
        case ToneCurve::filmic:
            return "filmic";
    }
    return "";
}

std::string command_text(std::span<const std::string> scene_arguments, const RenderSettings& settings,
                         const WriteOptions& look, const std::string& output) {
    std::string line = "nearlight render";
    for (const std::string& argument : scene_arguments) {
        line.push_back(' ');
        line += core::shell_word(argument);
    }
    add_view(line, settings.view);
    add_sampling(line, settings.sampling);
    add_gather(line, settings.gather, settings.sampling.sampler);
    add_option(line, "--seed", settings.seed, 0u);
    // Models have other defaults than Mitsuba's scenes, so the look is always said.
    line += " --exposure=" + text_of(look.exposure) + " --tonemap " + name_of(look.tone_curve);
    return line + " -o " + core::shell_word(output);
}

}  // namespace nearlight::viewer
