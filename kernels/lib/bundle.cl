// SPDX-License-Identifier: Apache-2.0
// Which packets form a bundle: those that are gathered together and that, with Russian roulette, ask about
// the same VPLs. host/base/receiver_bundles.h does the same on the host, and says why.
#ifndef NEARLIGHT_LIB_BUNDLE
#define NEARLIGHT_LIB_BUNDLE

#include "shared/types.h"

/// `count` packets that follow one another, from `first` on. The bundle is empty where `count` is 0.
typedef struct Bundle {
    uint first, count;
} Bundle;

/// The bundle with the number `index`, of packets that come in runs of `run_packets`. The last run may be
/// incomplete.
inline Bundle bundle_at(uint index, uint packet_count, uint run_packets) {
    const uint run_bundles = (run_packets + NEARLIGHT_BUNDLE_PACKETS - 1) / NEARLIGHT_BUNDLE_PACKETS;
    const uint offset = index % run_bundles * NEARLIGHT_BUNDLE_PACKETS;
    const uint first = index / run_bundles * run_packets + offset;
    const uint there = first < packet_count ? packet_count - first : 0;
    const Bundle bundle = {first, min(min(run_packets - offset, there), (uint)NEARLIGHT_BUNDLE_PACKETS)};
    return bundle;
}

#endif
