// SPDX-License-Identifier: Apache-2.0
// Russian roulette over the VPLs of a gather. It decides which VPLs of its stratum a bundle of receivers asks
// about, and how much each of these counts: 1/p for a VPL that is chosen with probability p, times the number
// of strata, which is unbiased.
//
// A whole bundle decides together (lib/bundle.cl), so that the beams that go through the tree stay full. It
// decides by what a VPL could bring to its receivers if nothing were in the way: the root mean square, which
// leaves the smallest error for a given number of bundles traced. In one bundle the choice is systematic
// along the order of the VPLs. With VPLs along a Morton curve, always about the right number of those near
// each other is chosen, which is far less noise than independent draws give. host/stages/roulette.h is the
// interface.

#include "lib/bundle.cl"
#include "lib/vpl_terms.cl"

// The minimum probability of a VPL that could bring light. It only keeps 1/p finite.
#define MIN_PROBABILITY 1e-6f

static inline float sum_of_lanes(float16 v) {
    const float8 a = v.lo + v.hi;
    const float4 b = a.lo + a.hi;
    const float2 c = b.lo + b.hi;
    return c.x + c.y;
}

/// The geometry term of a VPL, root mean square over the receivers of the bundle.
static inline float term_of_bundle(const global Vpl* vpl, const global ReceiverPacket* packets,
                                   const Bundle* bundle, float clamp_radius_squared) {
    float16 squares = (float16)0.0f;
    for (uint i = 0; i < bundle->count; ++i) {
        for (uint row = 0; row < NEARLIGHT_PACKET_SIZE / 16; ++row) {
            squares += squared_terms(vpl, packets + bundle->first + i, row, clamp_radius_squared);
        }
    }
    return sqrt(sum_of_lanes(squares) / (float)(max(bundle->count, 1u) * NEARLIGHT_PACKET_SIZE));
}

/// Sets bounds[(bundle − first_bundle)·stride + k] to the irradiance that VPL k of the bundle's stratum could
/// bring to the receivers of the bundle (root mean square, in its strongest channel), or to 0 if it faces
/// none of them. `stride` is the size of the largest stratum. One work-item for each run of `run_length` VPLs
/// of each bundle of [first_bundle, end_bundle).
kernel void roulette_bounds(const global Vpl* vpls, uint vpl_count, uint strata,
                            const global uint* stratum_of_bundle, uint stratum_period, uint stride,
                            uint run_length, const global ReceiverPacket* receivers, uint packet_count,
                            uint first_bundle, uint end_bundle, float clamp_radius_squared,
                            global float* bounds) {
    const uint runs = (stride + run_length - 1) / run_length;
    const uint item = (uint)get_global_id(0);
    const uint listed = item / runs;
    if (listed >= end_bundle - first_bundle) {
        return;
    }
    const Bundle bundle = bundle_at(first_bundle + listed, packet_count);
    const Stratum stratum =
        stratum_of(first_bundle + listed, vpl_count, strata, stratum_of_bundle, stratum_period);
    const uint first = item % runs * run_length;
    for (uint k = first; k < min(first + run_length, stratum.count); ++k) {
        const global Vpl* vpl = vpls + vpl_of_stratum(&stratum, k);
        const float3 scale = gather_scale(vpl);
        const float term = term_of_bundle(vpl, receivers, &bundle, clamp_radius_squared);
        bounds[(size_t)listed * stride + k] = term * fmax(scale.x, fmax(scale.y, scale.z));
    }
}

/// So many bounds are summed by themselves, so that a sum of many keeps its digits.
#define BLOCK_OF_BOUNDS 256

/// The bound below which a VPL is left to chance: `threshold` times the mean of all bounds.
static inline float roulette_limit(const global float* bounds, uint count, float threshold) {
    float total = 0.0f;
    for (uint block = 0; block < count; block += BLOCK_OF_BOUNDS) {
        float sum = 0.0f;
        for (uint i = block; i < min(block + BLOCK_OF_BOUNDS, count); ++i) {
            sum += bounds[i];
        }
        total += sum;
    }
    const float limit = threshold * total / (float)count;
    return limit < INFINITY ? limit : 0.0f;  // 0: nothing is left to chance
}

/// Lists the chosen VPLs of each bundle in their order in `chosen`, with strata/p in `weights`. The list of a
/// bundle begins at entry bundle·stride, where bundles count from first_bundle as in `bounds`, and
/// counts[bundle] is its length. One work-item for each bundle.
kernel void roulette_choose(const global float* bounds, uint vpl_count, uint strata,
                            const global uint* stratum_of_bundle, uint stratum_period, uint stride,
                            const global ReceiverPacket* receivers, uint packet_count, uint first_bundle,
                            uint end_bundle, float threshold, uint seed, global uint* chosen,
                            global float* weights, global uint* counts) {
    const uint listed = (uint)get_global_id(0);
    if (listed >= end_bundle - first_bundle) {
        return;
    }
    const Bundle bundle = bundle_at(first_bundle + listed, packet_count);
    const Stratum stratum =
        stratum_of(first_bundle + listed, vpl_count, strata, stratum_of_bundle, stratum_period);
    const size_t first = (size_t)listed * stride;
    const float limit = roulette_limit(bounds + first, stratum.count, threshold);
    float sum = bundle_number(receivers, &bundle, seed, 0x726f756cu);
    uint count = 0;
    for (uint k = 0; k < stratum.count; ++k) {
        const float bound = bounds[first + k];
        const bool certain = bound >= limit;
        const float p = certain ? 1.0f : fmax(bound / limit, MIN_PROBABILITY);
        sum += bound > 0.0f && !certain ? p : 0.0f;
        const bool lucky = sum >= 1.0f;
        sum -= lucky ? 1.0f : 0.0f;
        if (bound > 0.0f && (certain || lucky)) {
            chosen[first + count] = vpl_of_stratum(&stratum, k);
            weights[first + count] = (float)strata / p;
            ++count;
        }
    }
    counts[listed] = count;
}
