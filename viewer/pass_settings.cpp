// SPDX-License-Identifier: Apache-2.0
#include "viewer/pass_settings.h"

#include <algorithm>

namespace nearlight::viewer {
namespace {

/// Pixels of a square of this side ask different VPLs.
constexpr std::uint32_t kInterleave = 4;
/// The parts of the set of VPLs, of which a pixel asks one: in passes at least, and in quick pictures.
constexpr std::uint32_t kMinStrata = kInterleave * kInterleave;
constexpr std::uint32_t kQuickStrata = 32;
/// A set of VPLs serves so many passes.
constexpr std::uint32_t kPassesPerSet = 4;

std::uint32_t share_of(std::uint32_t whole, std::uint32_t passes) {
    return std::max(1u, (whole + passes - 1) / passes);
}

}  // namespace

GatherSettings pass_gather(const GatherSettings& whole, StepKind kind) {
    const std::uint32_t passes = std::max(whole.samples_per_pixel, 1u);
    GatherSettings settings = whole;
    settings.samples_per_pixel = 1;
    settings.interleave = kInterleave;
    if (kind == StepKind::refining) {
        constexpr std::uint32_t kDefaultDirect = 32;
        settings.strata = std::max(passes, kMinStrata);
        settings.direct_samples_per_pixel =
            share_of(whole.direct_samples_per_pixel.value_or(kDefaultDirect), passes);
        settings.rays_per_pixel = share_of(whole.rays_per_pixel, passes);
    } else {
        settings.strata = kQuickStrata;
        settings.direct_samples_per_pixel = 1;
        settings.rays_per_pixel = 1;
    }
    return settings;
}

ViewSettings pass_view(const ViewSettings& whole, int width, int height, int divisor) {
    ViewSettings settings = whole;
    settings.width = std::max(1, whole.width.value_or(width) / divisor);
    settings.height = std::max(1, whole.height.value_or(height) / divisor);
    settings.ray_budget_pilot = false;
    return settings;
}

std::uint32_t pass_seed(std::uint32_t seed, const Step& step) {
    return step.kind == StepKind::refining ? seed + step.pass : seed;
}

bool makes_vpls(const Step& step) {
    return step.kind == StepKind::refining && step.pass % kPassesPerSet == 1;
}

}  // namespace nearlight::viewer
