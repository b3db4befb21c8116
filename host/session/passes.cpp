// SPDX-License-Identifier: Apache-2.0
#include "host/session/passes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "host/base/division.h"
#include "host/base/limits.h"
#include "host/session/splat_rows.h"

namespace nearlight::core {
namespace {

/// `number` · part / whole, rounded up, at least 1 and at most `max`.
uint part_of(uint number, uint part, uint whole, uint max) {
    const std::uint64_t product = std::uint64_t{number} * part;
    return static_cast<uint>(std::clamp<std::uint64_t>(divide_rounding_up(product, whole), 1, max));
}

}  // namespace

bool may_have_passes(const RenderSettings& settings) {
    return settings.seconds || settings.error || settings.pass_samples.size() > 1 || settings.passes > 1u;
}

bool tells_error(std::span<const uint> samples) {
    return samples.size() > 1 || (!samples.empty() && samples.front() > 1);
}

uint pass_seed(uint seed, uint pass) {
    // This is SplitMix64 [Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014].
    std::uint64_t z = ((std::uint64_t{seed} << 32u) | pass) + 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30u)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27u)) * 0x94d049bb133111ebull;
    return pass == 0 ? seed : static_cast<uint>((z ^ (z >> 31u)) >> 32u);
}

uint min_pass_samples(const GatherSettings& settings) {
    return std::min(settings.samples_per_pixel, 2u);
}

uint min_later_samples(const GatherSettings& settings) {
    return settings.splat ? std::min(settings.samples_per_pixel, kMinSplattedSamples)
                          : min_pass_samples(settings);
}

RenderSettings with_samples(RenderSettings settings, uint samples) {
    GatherSettings& gather = settings.gather;
    const uint whole = gather.samples_per_pixel;
    if (samples == whole) {
        return settings;
    }
    const uint strata = gather.strata_or_auto();
    const uint fewer_strata = part_of(strata, samples, whole, std::numeric_limits<uint>::max());
    // A sample asks vpl_count / strata VPLs, so these two keep their quotient, as far as whole VPLs and the
    // limit of a set allow.
    const auto fewer = [&](uint count) {
        const auto rounded = static_cast<double>(std::llround(1.0 * count * fewer_strata / strata));
        return static_cast<uint>(std::clamp(rounded, count > 0 ? 1.0 : 0.0, 1.0 * kMaxVpls));
    };
    settings.sampling.vpl_count = fewer(settings.sampling.vpl_count);
    if (settings.sampling.set_count) {
        settings.sampling.set_count = fewer(*settings.sampling.set_count);
    }
    gather.strata = fewer_strata;
    if (gather.direct_samples_per_pixel) {
        gather.direct_samples_per_pixel =
            part_of(*gather.direct_samples_per_pixel, samples, whole, kMaxLightSamples);
    }
    gather.rays_per_pixel = part_of(gather.rays_per_pixel, samples, whole, kMaxLightSamples);
    gather.samples_per_pixel = samples;
    return settings;
}

}  // namespace nearlight::core
