// SPDX-License-Identifier: Apache-2.0
// What both gather kernels share.
//
// With GATHER_RECORD defined, the kernels also write one byte for each (receiver, VPL) pair that says what
// became of it, so that tests and benchmarks can compare hit by hit.
#ifndef NEARLIGHT_LIB_GATHER
#define NEARLIGHT_LIB_GATHER

#include "lib/bundle.cl"
#include "lib/vpl_terms.cl"
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

#endif
