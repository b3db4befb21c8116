// SPDX-License-Identifier: Apache-2.0
// What the host must know of walks from lights (lib/light_walk.cl).
#ifndef NEARLIGHT_SHARED_LIGHT_WALK_H
#define NEARLIGHT_SHARED_LIGHT_WALK_H

// How many pairs of random numbers a walk takes: on the light, and for each step from there.
#define NEARLIGHT_WALK_PAIRS_ON_LIGHT 3
#define NEARLIGHT_WALK_PAIRS_PER_STEP 2

// Which deposits in the close range a policy keeps (docs/method.md).
#define NEARLIGHT_KEEP_ALL 0u              // complete, and samplers without a close range
#define NEARLIGHT_KEEP_INDIRECT_INSIDE 1u  // partition: inside the close range, depth 2 and more
#define NEARLIGHT_KEEP_OUTSIDE 2u          // paper: nothing inside the close range

#endif
