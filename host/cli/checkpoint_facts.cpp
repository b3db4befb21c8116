// SPDX-License-Identifier: Apache-2.0
#include "host/cli/checkpoint_facts.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "host/base/hash.h"
#include "host/base/words.h"
#include "host/bvh/bvh.h"
#include "host/cl/kernel_source.h"
#include "host/cli/log.h"
#include "host/samplers/sampler.h"
#include "host/stages/device_tree.h"

namespace nearlight::core {
namespace {

using Facts = nlohmann::ordered_json;

constexpr const char* kCompensate = "--compensate";
constexpr const char* kPolicy = "--policy";

/// The program's version with a hash of the kernels, which decide what a pass is.
std::string version_with_kernels(const std::filesystem::path& kernel_dir) {
    return std::string(NEARLIGHT_VERSION) + " with kernels " + hex_digits(kernels_hash(kernel_dir));
}

template <typename Value>
Facts or_auto(const std::optional<Value>& value) {
    return value ? Facts(*value) : Facts("auto");
}

Facts settings_facts(const Scene& scene, const RenderSettings& settings) {
    const auto& [view, sampling, gather] = std::tie(settings.view, settings.sampling, settings.gather);
    const auto on_off = [](bool is_on) { return is_on ? "on" : "off"; };
    Facts facts;
    facts["--size"] = fmt::format("{}x{}", view.width.value_or(scene.camera.width),
                                  view.height.value_or(scene.camera.height));
    facts["--crop"] = gather.window
                          ? Facts(fmt::format("{}x{}+{}+{}", gather.window->width, gather.window->height,
                                              gather.window->x, gather.window->y))
                          : Facts("none");
    facts["--max-depth"] = or_auto(view.max_depth);
    facts["--sampler"] = sampler_name(sampling);
    facts[kPolicy] = policy_name(sampling).value_or("none");
    facts["--vpls"] = sampling.vpl_count;
    facts["--cuts"] = on_off(sampling.cuts);
    facts["--vpl-set"] = sampling.set_count_or_auto();
    facts["--close-fraction"] = or_auto(sampling.close_fraction);
    facts["--range"] = or_auto(view.range);
    facts["--clamp-radius"] = or_auto(view.clamp_radius);
    facts["--preview"] = on_off(!view.ray_budget_pilot);
    facts["--spp"] = gather.samples_per_pixel;
    facts["--strata"] = gather.strata_or_auto();
    facts["interleave"] = gather.interleave;
    facts["--direct-samples"] = or_auto(gather.direct_samples_per_pixel);
    facts[kCompensate] = on_off(gather.compensate);
    facts["--refine"] = on_off(gather.refine);
    facts["--splat"] = on_off(gather.splat);
    facts["--rays"] = gather.rays_per_pixel;
    facts["--roulette"] = gather.roulette;
    facts["indirect_only"] = gather.indirect_only;
    return facts;
}

/// The devices by name and driver, each kind once.
std::string device_kinds(const std::vector<std::unique_ptr<Device>>& devices) {
    std::set<std::string> kinds;
    for (const auto& device : devices) {
        kinds.insert(fmt::format("'{}', driver {}", device->entry().name, device->entry().driver));
    }
    return joined(kinds, " and ");
}

std::string shown(const Facts& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::optional<std::string> first_difference(const Facts& theirs, const Facts& ours) {
    for (const auto& [name, value] : ours.items()) {
        const auto found = theirs.find(name);
        if (found == theirs.end() || *found != value) {
            return fmt::format("it has {} {}, and not {}", name,
                               found == theirs.end() ? "unknown" : shown(*found), shown(value));
        }
    }
    return std::nullopt;
}

CheckpointFacts checkpoint_facts(const Scene& scene, std::uint64_t scene_hash, const RenderSettings& settings,
                                 const SessionOptions& options,
                                 const std::vector<std::unique_ptr<Device>>& devices) {
    CheckpointFacts facts;
    facts.version = version_with_kernels(devices.front()->options().kernel_dir);
    facts.scene_hash = scene_hash;
    facts.settings = settings_facts(scene, settings);
    facts.maker["--device"] = device_kinds(devices);
    facts.maker["--gather"] = to_string(options.gather_kernel);
    facts.maker["--bvh"] = to_string(options.bvh_quality);
    return facts;
}

std::optional<std::string> difference_of_pictures(const CheckpointFacts& theirs,
                                                  const CheckpointFacts& ours) {
    if (theirs.version != ours.version) {
        return fmt::format("nearlight {} made it, and not {}", theirs.version, ours.version);
    }
    if (theirs.scene_hash != ours.scene_hash) {
        return "it is of another scene, or of other options that change the scene";
    }
    return first_difference(theirs.settings, ours.settings);
}

std::optional<std::string> difference_of_bits(const CheckpointFacts& theirs, const CheckpointFacts& ours) {
    return first_difference(theirs.maker, ours.maker);
}

void mark_differences_of_bits(const CheckpointFacts& part, CheckpointFacts& sum) {
    for (auto& [name, value] : sum.maker.items()) {
        const auto found = part.maker.find(name);
        if (found == part.maker.end() || *found != value) {
            value = "several";
        }
    }
}

bool mean_depends_on_choice(const CheckpointFacts& facts) {
    const auto is = [&](const char* name, const std::string& text) {
        const auto found = facts.settings.find(name);
        return found != facts.settings.end() && *found == text;
    };
    return !is(kCompensate, "on") || is(kPolicy, to_string(Policy::paper));
}

}  // namespace nearlight::core
