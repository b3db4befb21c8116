// SPDX-License-Identifier: Apache-2.0
// Which packets form a bundle: those that are gathered together and that ask about the same VPLs.
// host/base/receiver_bundles.h does the same on the host.
#ifndef NEARLIGHT_LIB_BUNDLE
#define NEARLIGHT_LIB_BUNDLE

#include "lib/random.cl"
#include "shared/types.h"

#define BUNDLE_RECEIVERS (NEARLIGHT_BUNDLE_PACKETS * NEARLIGHT_PACKET_SIZE)

/// `count` packets that follow one another, from `first` on. The bundle is empty where `count` is 0.
typedef struct Bundle {
    uint first, count;
} Bundle;

/// The bundle with the number `index`. The last one may be incomplete.
static inline Bundle bundle_at(uint index, uint packet_count) {
    const uint first = index * NEARLIGHT_BUNDLE_PACKETS;
    const uint there = first < packet_count ? packet_count - first : 0;
    const Bundle bundle = {first, min(there, (uint)NEARLIGHT_BUNDLE_PACKETS)};
    return bundle;
}

/// A uniform number in [0, 1) for a bundle and one purpose. It is a hash of where the bundle's receivers are,
/// so that no division of a picture changes it.
static inline float bundle_number(const global ReceiverPacket* packets, const Bundle* bundle, uint seed,
                                  uint purpose) {
    uint4 key = (uint4)(seed, purpose, 0, 0);
    for (uint i = 0; i < bundle->count; ++i) {
        const global ReceiverPacket* packet = packets + bundle->first + i;
        for (uint lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
            key ^= (uint4)(as_uint(packet->px[lane]), as_uint(packet->py[lane]), as_uint(packet->pz[lane]),
                           lane);
            key = random_uint4(key);
        }
    }
    return to_unit_float(key.x);
}

/// The VPLs that a bundle may ask about: every `step`-th of the set from `first` on, `count` in all. Each of
/// them counts `step` times, so that every stratum has the expectation of the whole set.
typedef struct Stratum {
    uint first, step, count;
} Stratum;

/// The stratum of a bundle. `strata` has the strata of the bundles 0 to period − 1, which repeat; it is not
/// read if there is only one.
static inline Stratum stratum_of(uint bundle, uint vpl_count, uint stratum_count, const global uint* strata,
                                 uint period) {
    const uint first = stratum_count > 1 ? strata[bundle % period] : 0;
    const Stratum stratum = {first, stratum_count,
                             first < vpl_count ? (vpl_count - first - 1) / stratum_count + 1 : 0};
    return stratum;
}

static inline uint vpl_of_stratum(const Stratum* stratum, uint k) {
    return stratum->first + k * stratum->step;
}

#endif
