// SPDX-License-Identifier: Apache-2.0
// What a gather may record of each (receiver, VPL) pair (lib/gather.cl).
#ifndef NEARLIGHT_SHARED_GATHER_RECORD_H
#define NEARLIGHT_SHARED_GATHER_RECORD_H

#define NEARLIGHT_PAIR_CULLED 0  // no ray was traced; open_term() in gather_rays.cl says when
#define NEARLIGHT_PAIR_VISIBLE 1
#define NEARLIGHT_PAIR_OCCLUDED 2

#endif
