// SPDX-License-Identifier: Apache-2.0
// What both gather kernels share.
//
// With GATHER_RECORD defined, the kernels also write one byte for each (receiver, VPL) pair that says what
// became of it, so that tests and benchmarks can compare hit by hit.
#ifndef NEARLIGHT_LIB_GATHER
#define NEARLIGHT_LIB_GATHER

#include "lib/bundle.cl"
#include "lib/math.cl"
#include "shared/gather_record.h"

#ifndef GATHER_CHUNK
#define GATHER_CHUNK 256  // VPLs that are summed before the sum is added to the irradiance
#endif

#ifdef GATHER_RECORD
#define GATHER_RECORD_PARAMETERS , global uchar* record
static inline size_t gather_record_index(uint packet, uint vpl, uint vpl_count, uint lane) {
    return ((size_t)packet * vpl_count + vpl) * NEARLIGHT_PACKET_SIZE + lane;
}
#else
#define GATHER_RECORD_PARAMETERS
#endif

// With GATHER_LISTS defined, each bundle of packets asks about a list of VPLs instead of all of its stratum
// (host/stages/vpl_selection.h). The argument `k` of these macros is a place in that list, or without lists
// in the stratum.
#ifdef GATHER_LISTS
#define GATHER_LIST_PARAMETERS \
    , const global uint *listed_vpls, const global float *list_weights, const global uint *list_lengths
static inline size_t gather_list(uint bundle, const GatherParams* params) {
    return (size_t)(bundle - params->first_listed_bundle) * params->list_stride;
}
#define GATHER_COUNT(bundle, params, stratum) \
    ((void)(stratum), list_lengths[(bundle) - (params)->first_listed_bundle])
#define GATHER_VPL(bundle, params, stratum, k) listed_vpls[gather_list(bundle, params) + (k)]
#define GATHER_WEIGHT(bundle, params, stratum, k) list_weights[gather_list(bundle, params) + (k)]
#else
#define GATHER_LIST_PARAMETERS
#define GATHER_COUNT(bundle, params, stratum) ((stratum)->count)
#define GATHER_VPL(bundle, params, stratum, k) vpl_of_stratum(stratum, k)
#define GATHER_WEIGHT(bundle, params, stratum, k) ((float)(stratum)->step)
#endif

static inline Stratum gather_stratum(uint bundle, const GatherParams* params, const global uint* strata) {
    return stratum_of(bundle, params->vpl_count, params->strata, strata, params->stratum_period);
}

/// The number of VPLs that are summed by themselves: `group_size`, or GATHER_CHUNK where that is 0.
static inline uint gather_chunk_size(uint group_size) {
    return group_size != 0 ? group_size : GATHER_CHUNK;
}

/// An importon as the gather reads it. The struct Importon in shared/types.h has the members of a Vpl in the
/// same places.
static inline const global Vpl* as_source(const global Importon* importon) {
    return (const global Vpl*)importon;
}

/// Whether the gather sums squares of the geometry term, which tell the error that a VPL would leave, instead
/// of light.
static inline bool gather_squared(const global Vpl* vpl) {
    return (vpl->flags & NEARLIGHT_IMPORTON_SQUARED) != 0;
}

/// Radiant intensity of the VPL along its normal, W/sr, or 0 if its power is not finite, so that the VPL is
/// left out.
static inline float3 gather_scale(const global Vpl* vpl) {
    const float3 power = load3(vpl->power);
    const bool finite = isfinite(power.x) && isfinite(power.y) && isfinite(power.z);
    return finite ? power * M_1_PI_F : (float3)0.0f;
}

/// The factor from the square of a pair's geometry term to the square of the pair's light, R, G and B
/// together. `scale` comes from gather_scale().
static inline float gather_square_scale(const global Vpl* vpl, float3 scale) {
    return gather_squared(vpl) ? scale.x + scale.y + scale.z : dot(scale, scale);
}

/// Squares of the geometry terms of the VPL and the 16 receivers of a row of the packet, without visibility.
/// They are 0 where a cosine is not positive or the term is not finite.
static inline float16 squared_terms(const global Vpl* vpl, const global ReceiverPacket* packet, uint row,
                                    float clamp_radius_squared) {
    const float3 origin = load3(vpl->position);
    const float3 vpl_normal = load3(vpl->normal);
    const float16 dx = vload16(row, packet->px) - origin.x;
    const float16 dy = vload16(row, packet->py) - origin.y;
    const float16 dz = vload16(row, packet->pz) - origin.z;
    const float16 cos_vpl = vpl_normal.x * dx + vpl_normal.y * dy + vpl_normal.z * dz;
    const float16 cos_receiver =
        -(vload16(row, packet->nx) * dx + vload16(row, packet->ny) * dy + vload16(row, packet->nz) * dz);
    const float16 r2 = dx * dx + dy * dy + dz * dz;
    const float16 term = cos_vpl * cos_receiver / (r2 * fmax(r2, (float16)clamp_radius_squared));
    const int16 open = (cos_vpl > 0.0f) & (cos_receiver > 0.0f) & (term < INFINITY);
    return open ? term * term : (float16)0.0f;
}

#endif
