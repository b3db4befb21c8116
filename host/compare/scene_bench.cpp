// SPDX-License-Identifier: Apache-2.0
#include "host/compare/scene_bench.h"

#include "host/base/message.h"
#include "host/compare/pictures.h"
#include "host/image/image_io.h"
#include "host/reference/path_tracer.h"
#include "host/scene/emitters.h"
#include "host/stages/film_layers.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

/// First seed of references, far from the seeds that users give.
constexpr uint kReferenceSeed = 0x5eed0000u;

/// Copies `count` neighbouring channels out of finished rows.
void append_channels(std::span<const float> rows, std::size_t first, std::size_t count,
                     std::vector<float>& values) {
    for (std::size_t i = first; i < rows.size(); i += NEARLIGHT_LAYER_CHANNELS) {
        const auto pixel = rows.subspan(i, count);
        values.insert(values.end(), pixel.begin(), pixel.end());
    }
}

std::optional<Error> objection_to_dark(const Scene& scene, const std::string& name) {
    if (!build_emitter_table(scene).emitters.empty()) {
        return std::nullopt;
    }
    return Error(ErrorKind::file,
                 "scene '" + name + "' (" + scene.source.string() +
                     "): nothing in it emits light, so there is nothing to compare; add a light");
}

float clamp_radius_of(const std::filesystem::path& reference_file) {
    const Metadata metadata = read_metadata(reference_file);
    const auto found = metadata.find("nearlight:clampRadius");
    const float* const radius = found == metadata.end() ? nullptr : std::get_if<float>(&found->second);
    return radius == nullptr ? 0.0f : *radius;
}

}  // namespace

SceneBench::SceneBench(Device& device, const Scene& scene, const std::string& name,
                       const CompareSettings& settings,
                       const std::optional<std::filesystem::path>& reference_file)
    : scene_(scene), settings_(settings), session_(device, scene, {.bvh_quality = settings.bvh_quality}) {
    facts_.name = name;
    facts_.source = scene.source.string();
    facts_.hash = scene_hash(scene);
    facts_.triangles = scene.triangles.size();
    objection_ = objection_to_dark(scene, name);
    if (!objection_) {
        objection_ = objection_to(look());
        facts_.clamp_radius = choose_clamp_radius(reference_file);
    }
}

SceneBench::FirstLook SceneBench::look() {
    RenderSettings settings =
        render_settings(settings_.baseline, settings_.vpl_counts.front(), settings_.first_seed);
    settings.gather.indirect_only = false;
    settings.view.range = settings_.range;
    settings.view.clamp_radius = settings_.clamp_radius;
    settings.view.max_depth = settings_.max_depth;
    FirstLook found;
    overview_ = make_picture(settings_.width, settings_.height);
    overview_.values.clear();
    RenderHooks hooks;
    hooks.open = [&](const RenderReport&, const View& view, const VplSet& vpls) {
        facts_.camera = view.scene_camera;
        found.surface = !view.pilot.distances.empty();
        found.close_vpls = settings.sampling.sampler != SamplerKind::close_range || vpls.close_count > 0;
    };
    hooks.rows = [&](std::span<const float> rows) {
        append_channels(rows, NEARLIGHT_LAYER_BEAUTY, NEARLIGHT_CHANNELS_RGB, overview_.values);
        append_channels(rows, NEARLIGHT_LAYER_DEPTH, NEARLIGHT_CHANNELS_Z, depths_);
    };
    const RenderReport report = render(session_, settings, hooks);
    facts_.range = report.range;
    facts_.max_depth = report.max_depth;
    facts_.setup = {report.seconds.build_bvh, report.seconds.compile};
    return found;
}

std::optional<Error> SceneBench::objection_to(const FirstLook& found) const {
    const std::string scene = "scene '" + facts_.name + "' (" + facts_.source + ")";
    if (!found.surface) {
        return Error(ErrorKind::file,
                     scene + ": the camera sees no diffuse surface, so there is nothing to compare; " +
                         "turn it towards the scene");
    }
    if (facts_.max_depth < 3) {
        return Error(ErrorKind::file,
                     scene + " has a depth of " + std::to_string(facts_.max_depth) +
                         ", which leaves no indirect light to compare; use 3 or more",
                     "max_depth");
    }
    if (!found.close_vpls) {
        say_warning(scene + ": no light reaches the close range (range " + std::to_string(facts_.range) +
                    "), so close-range sampling is instant radiosity here");
    }
    return std::nullopt;
}

float SceneBench::choose_clamp_radius(const std::optional<std::filesystem::path>& reference_file) const {
    if (settings_.clamp_radius) {
        return *settings_.clamp_radius;
    }
    if (reference_file && !settings_.clamp_fraction) {
        const float radius = clamp_radius_of(*reference_file);
        if (radius == 0.0f) {
            say_warning(
                "'" + reference_file->string() +
                "' was made without a clamp radius, so no sampler has one; --clamp-fraction gives them "
                "one again, but then the reference must be made with that radius");
        }
        return radius;
    }
    return settings_.clamp_fraction.value_or(kDefaultClampFraction) * facts_.range;
}

RenderSettings SceneBench::render_settings(const Method& method, uint vpls, uint seed) const {
    return {.view = {.width = settings_.width,
                     .height = settings_.height,
                     .range = facts_.range,
                     .clamp_radius = facts_.clamp_radius,
                     .max_depth = facts_.max_depth},
            .sampling = {.sampler = method.sampler,
                         .policy = method.policy.value_or(SamplingSettings{}.policy),
                         .vpl_count = vpls},
            .gather = {.samples_per_pixel = settings_.samples_per_pixel,
                       .strata = 1,
                       .compensate = false,
                       .refine = false,
                       .splat = false,
                       .indirect_only = true},
            .seed = seed};
}

std::optional<Shot> SceneBench::render_indirect(const RenderSettings& settings, const Progress& progress) {
    Shot shot{make_picture(settings_.width, settings_.height), {}};
    shot.indirect.values.clear();
    RenderHooks hooks;
    hooks.rows = [&](std::span<const float> rows) {
        append_channels(rows, NEARLIGHT_LAYER_INDIRECT, NEARLIGHT_CHANNELS_RGB, shot.indirect.values);
    };
    hooks.progress = [&](double fraction) { return progress(fraction); };
    shot.report = render(session_, settings, hooks);
    return shot.report.interrupted ? std::nullopt : std::optional(std::move(shot));
}

std::optional<Shot> SceneBench::shoot(const Method& method, uint vpls, uint seed, const Progress& progress) {
    if (!std::exchange(warm_[to_string(method)], true)) {
        render_indirect(render_settings(method, settings_.vpl_counts.front(), kReferenceSeed), progress);
    }
    return render_indirect(render_settings(method, vpls, seed), progress);
}

VplSet SceneBench::sample(const Method& method, uint vpls, uint seed) {
    const RenderSettings settings = render_settings(method, vpls, seed);
    return session_.sample(session_.look(settings.view, seed), settings.sampling, seed);
}

ReferenceSpec SceneBench::reference_spec() const {
    return {.sampler = settings_.reference_vpls > 0
                           ? settings_.reference_sampler.value_or(Method{SamplerKind::instant_radiosity, {}})
                           : std::optional<Method>(),
            .scene_name = facts_.name,
            .scene_hash = facts_.hash,
            .width = settings_.width,
            .height = settings_.height,
            .clamp_radius = facts_.clamp_radius,
            .max_depth = facts_.max_depth,
            .pixel_centers = settings_.samples_per_pixel == 1};
}

std::optional<Image> SceneBench::trace_pass(const ReferenceSpec& spec, std::size_t index, std::size_t samples,
                                            const Progress& progress) const {
    bool stopped = false;
    const Image traced = trace_paths(scene_,
                                     {.width = spec.width,
                                      .height = spec.height,
                                      .spp = static_cast<int>(samples),
                                      .max_depth = static_cast<int>(spec.max_depth),
                                      .clamp_radius = spec.clamp_radius,
                                      .indirect_only = true,
                                      .pixel_centers = spec.pixel_centers,
                                      .seed = kReferenceSeed + index},
                                     [&](double fraction) {
                                         stopped = !progress(fraction);
                                         return !stopped;
                                     });
    if (stopped) {
        return std::nullopt;
    }
    const Image indirect = color_layer(traced, "indirect");
    const Image variance = color_layer(traced, "indirectVariance");
    Image pass =
        make_image(spec.width, spec.height, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
    for (std::size_t i = 0; i < indirect.values.size(); ++i) {
        pass.values[i / 3 * 6 + i % 3] = indirect.values[i];
        pass.values[i / 3 * 6 + i % 3 + 3] = variance.values[i];
    }
    return pass;
}

PassMaker SceneBench::reference_maker(const ReferenceSpec& spec, const Progress& progress,
                                      std::size_t total_samples) {
    return [this, spec, progress, total_samples](std::size_t index,
                                                 std::size_t samples) -> std::optional<Image> {
        const auto total = static_cast<double>(total_samples);
        const double before = static_cast<double>(index * pass_sizes(spec, total_samples).front()) / total;
        const Progress pass_progress = [&](double fraction) {
            return progress(before + fraction * static_cast<double>(samples) / total);
        };
        if (!spec.sampler) {
            return trace_pass(spec, index, samples, pass_progress);
        }
        const std::optional<Shot> shot =
            render_indirect(render_settings(*spec.sampler, static_cast<uint>(samples),
                                            kReferenceSeed + static_cast<uint>(index)),
                            pass_progress);
        return shot ? std::optional(shot->indirect) : std::nullopt;
    };
}

}  // namespace nearlight::core
