// SPDX-License-Identifier: Apache-2.0
#include "viewer/pass_settings.h"

#include <algorithm>

namespace nearlight::viewer {
namespace {

/// The set of VPLs has at least so many parts; a pixel asks one of them.
constexpr std::uint32_t kMinStrata = kInterleave * kInterleave;
/// More are refused by Session::gather().
constexpr std::uint32_t kMaxStrata = 65536;
/// A pixel of a quick picture asks so many VPLs: fewer save little, because camera and light rays cost
/// as much.
constexpr std::uint32_t kQuickVpls = 8;
/// A set of VPLs serves so many passes.
constexpr std::uint32_t kPassesPerSet = 4;

std::uint32_t share_of(std::uint32_t whole, std::uint32_t passes) {
    return std::max(1u, (whole + passes - 1) / passes);
}

}  // namespace

GatherSettings pass_gather(const RenderSettings& whole, StepKind kind) {
    GatherSettings settings = whole.gather;
    const std::uint32_t passes = std::max(settings.samples_per_pixel, 1u);
    settings.samples_per_pixel = 1;
    settings.interleave = kInterleave;
    if (kind == StepKind::refining) {
        settings.spread_single_samples = true;
        settings.strata = std::max(passes, kMinStrata);
        settings.direct_samples_per_pixel =
            share_of(settings.direct_samples_per_pixel.value_or(kDefaultDirectSamples), passes);
        settings.rays_per_pixel = share_of(settings.rays_per_pixel, passes);
    } else {
        settings.strata = std::clamp(whole.sampling.vpl_count / kQuickVpls, kMinStrata, kMaxStrata);
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
