// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_output.h"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <limits>
#include <optional>

#include "host/base/hash.h"
#include "host/base/memory.h"
#include "host/base/words.h"
#include "host/cli/log.h"
#include "host/cli/pass_list.h"
#include "host/cli/picture_files.h"
#include "host/cli/tunables_output.h"

namespace nearlight::core {
namespace {

/// The results of `text` for all devices, separated by commas and without duplicates.
template <typename Text>
std::string text_of_devices(const std::vector<std::unique_ptr<Device>>& devices, const Text& text) {
    std::vector<std::string> parts;
    for (const auto& device : devices) {
        if (const std::string part = text(device->entry()); std::ranges::find(parts, part) == parts.end()) {
            parts.push_back(part);
        }
    }
    return joined(parts, ", ");
}

/// The share of one device in all finished bands.
double share_of(const BandShare& one, std::span<const BandShare> all) {
    uint total = 0;
    for (const BandShare& share : all) {
        total += share.bands;
    }
    return total > 0 ? static_cast<double>(one.bands) / total : 0.0;
}

/// The number, or null where there is none.
template <typename T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

void add_passes(nlohmann::ordered_json& json, const RenderSettings& settings, const RenderReport& report) {
    json["sampler"] = sampler_name(settings.sampling);
    json["policy"] = or_null(policy_name(settings.sampling));
    json["vpl_file"] = settings.sampling.file.empty()
                           ? nlohmann::ordered_json()
                           : nlohmann::ordered_json(settings.sampling.file.string());
    json["samples_per_pixel"] = settings.gather.samples_per_pixel;
    json["strata"] = settings.gather.strata_or_auto();
    json["preview"] = settings.gather.interleave > 1;
    json["passes"] = report.passes;
    json["pass_spp"] = pass_list_text(report.pass_samples);
    json["relative_error"] = or_null(report.error);
    json["relative_error_asked"] = or_null(settings.error);
}

/// Whether pixels ask a part of the set only. A file of VPLs says so itself.
bool asks_part(const SamplingSettings& sampling, const RenderReport& report) {
    return sampling.file.empty() ? sampling.cuts : report.asked_count > 0;
}

void add_vpls(nlohmann::ordered_json& json, const RenderSettings& settings, const RenderReport& report) {
    const bool is_loaded = !settings.sampling.file.empty();
    const std::size_t count = report.totals.close_vpls + report.totals.distant_vpls;
    json["vpls"] = {{"requested", settings.sampling.vpl_count},
                    {"set", is_loaded ? count : settings.sampling.set_count_or_auto()},
                    {"close", report.totals.close_vpls},
                    {"distant", report.totals.distant_vpls},
                    {"sparse", report.totals.sparse_vpls},
                    {"candidates", report.totals.candidates},
                    {"local_lights", report.totals.local_lights}};
    if (is_loaded) {
        json["vpls"]["requested"] = nullptr;
    }
    json["close_fraction"] = report.close_fraction;
    json["range"] = report.range;
}

void add_method(nlohmann::ordered_json& json, const RenderFacts& facts) {
    const RenderSettings& settings = facts.settings;
    const RenderReport& report = facts.report;
    json["clamp_radius"] = report.ray_budget.clamp_radius;
    json["rays_per_pixel"] = settings.gather.rays_per_pixel;
    json["direct_samples_per_pixel"] = report.ray_budget.direct_samples_per_pixel;
    json["compensate"] = settings.gather.compensate;
    json["refine"] = has_refinement(report, settings.gather);
    json["splat"] = has_splats(report, settings.gather);
    json["glass"] = glass_name(facts.scene.clear_glass);
    json["max_depth"] = report.max_depth;
    json["filter"] = to_string(report.filter.kind);
    json["seed"] = settings.seed;
    json["bvh"] = to_string(facts.bvh);
    json["cuts"] = asks_part(settings.sampling, report);
    json["roulette"] = settings.gather.roulette;
    json["denoiser"] = facts.picture.denoiser();
}

void add_devices(nlohmann::ordered_json& json, const RenderFacts& facts) {
    json["device"] = nlohmann::ordered_json::array();
    json["device_shares"] = nlohmann::ordered_json::array();
    for (const BandShare& share : facts.report.shares) {
        json["device"].push_back(share.name);
        json["device_shares"].push_back({{"device", share.name},
                                         {"bands", share.bands},
                                         {"share", share_of(share, facts.report.shares)},
                                         {"seconds", share.seconds},
                                         {"failed", share.failed}});
    }
    json["compute_units"] = nlohmann::ordered_json::array();
    json["tunables"] = nlohmann::ordered_json::array();
    for (const auto& device : facts.devices) {
        json["compute_units"].push_back(device->entry().compute_units);
        json["tunables"].push_back({{"device", device->entry().label()}});
        json["tunables"].back().update(to_json(device->chosen_tunables()));
    }
}

void add_seconds(nlohmann::ordered_json& json, const RenderFacts& facts) {
    const RenderReport& report = facts.report;
    const double total = facts.load_seconds + report.seconds.total + facts.picture.denoising_seconds() +
                         facts.picture.matte_seconds();
    json["seconds"] = {{"load", facts.load_seconds},
                       {"build_bvh", report.seconds.build_bvh},
                       {"compile", report.seconds.compile},
                       {"upload", report.seconds.upload},
                       {"generate", report.seconds.generate},
                       {"gather", report.seconds.gather},
                       {"first_rows", facts.first_rows.seconds},
                       {"denoise", facts.picture.denoising_seconds()},
                       {"mattes", facts.picture.matte_seconds()},
                       {"total", total}};
    json["processor_seconds"] = {{"first_rows", facts.first_rows.processor_seconds}};
}

}  // namespace

Metadata::mapped_type count_value(std::uint64_t count) {
    if (count <= std::uint64_t{std::numeric_limits<int>::max()}) {
        return static_cast<int>(count);
    }
    return std::to_string(count);
}

Metadata render_metadata(std::uint64_t scene_hash, const SceneOptions& scene, const RenderSettings& settings,
                         const RenderReport& report, const View& view,
                         const std::vector<std::unique_ptr<Device>>& devices,
                         const std::string& command_line) {
    Metadata metadata = camera_metadata(view.scene_camera);
    metadata["nearlight:version"] = std::string(NEARLIGHT_VERSION);
    metadata["nearlight:sampler"] = sampler_name(settings.sampling);
    metadata["nearlight:policy"] = policy_name(settings.sampling).value_or("none");
    if (!settings.sampling.file.empty()) {
        metadata["nearlight:vplFile"] = settings.sampling.file.string();
    }
    const std::uint64_t vpls = report.totals.close_vpls + report.totals.distant_vpls;
    const std::uint64_t of_file = report.asked_count > 0 ? report.asked_count : vpls;
    metadata["nearlight:vpls"] = count_value(vpls);
    metadata["nearlight:vplsAsked"] =
        count_value(settings.sampling.file.empty() ? settings.sampling.vpl_count : of_file);
    metadata["nearlight:cuts"] = asks_part(settings.sampling, report) ? "on" : "off";
    metadata["nearlight:spp"] = static_cast<int>(settings.gather.samples_per_pixel);
    metadata["nearlight:strata"] = static_cast<int>(settings.gather.strata_or_auto());
    metadata["nearlight:preview"] = settings.gather.interleave > 1 ? "on" : "off";
    metadata["nearlight:passes"] = static_cast<int>(report.passes);
    metadata["nearlight:passSpp"] = pass_list_text(report.pass_samples);
    if (report.error) {
        metadata["nearlight:error"] = static_cast<float>(*report.error);
        metadata["nearlight:errorAsked"] = static_cast<float>(*settings.error);
    }
    metadata["nearlight:clampRadius"] = report.ray_budget.clamp_radius;
    metadata["nearlight:raysPerPixel"] = static_cast<int>(settings.gather.rays_per_pixel);
    metadata["nearlight:directSamplesPerPixel"] =
        static_cast<int>(report.ray_budget.direct_samples_per_pixel);
    metadata["nearlight:compensate"] = settings.gather.compensate ? "on" : "off";
    metadata["nearlight:refine"] = has_refinement(report, settings.gather) ? "on" : "off";
    metadata["nearlight:splat"] = has_splats(report, settings.gather) ? "on" : "off";
    metadata["nearlight:glass"] = glass_name(scene.clear_glass);
    metadata["nearlight:range"] = report.range;
    metadata["nearlight:maxDepth"] = static_cast<int>(report.max_depth);
    metadata["nearlight:filter"] = to_string(view.scene_camera.filter.kind);
    metadata["nearlight:seed"] = count_value(settings.seed);
    metadata["nearlight:device"] =
        text_of_devices(devices, [](const DeviceEntry& entry) { return entry.label(); });
    metadata["nearlight:driver"] =
        text_of_devices(devices, [](const DeviceEntry& entry) { return entry.driver; });
    metadata["nearlight:sceneHash"] = hex_digits(scene_hash);
    metadata["nearlight:commandLine"] = command_line;
    return metadata;
}

void FirstRows::note(const Stopwatch& since_begin) {
    if (seconds == 0.0) {
        timespec now{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
        seconds = since_begin.seconds();
        processor_seconds = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }
}

nlohmann::ordered_json render_json(const RenderFacts& facts) {
    const RenderReport& report = facts.report;
    nlohmann::ordered_json json;
    json["scene"] = facts.scene.file.string();
    json["width"] = report.width;
    json["height"] = report.height;
    add_passes(json, facts.settings, report);
    add_vpls(json, facts.settings, report);
    add_method(json, facts);
    add_devices(json, facts);
    add_seconds(json, facts);
    json["peak_bytes"] = {{"host", peak_host_bytes()}, {"device", report.device_bytes}};
    json["outputs"] = facts.outputs;
    json["image_hash"] = hex_digits(report.image_hash);
    json["interrupted"] = report.interrupted;
    return json;
}

void tell_shares(const RenderReport& report) {
    if (report.shares.size() < 2) {
        return;
    }
    for (const BandShare& share : report.shares) {
        spdlog::info("{:.0f} % by {}{}", 100 * share_of(share, report.shares), share.name,
                     share.failed ? ", which failed" : "");
    }
}

}  // namespace nearlight::core
