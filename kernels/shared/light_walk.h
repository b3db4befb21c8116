// SPDX-License-Identifier: Apache-2.0
// The random numbers of walks from lights (lib/light_walk.cl).
#ifndef NEARLIGHT_SHARED_LIGHT_WALK_H
#define NEARLIGHT_SHARED_LIGHT_WALK_H

// How many pairs of random numbers a walk takes: on the light, and for each step from there.
#define NEARLIGHT_WALK_PAIRS_ON_LIGHT 3
#define NEARLIGHT_WALK_PAIRS_PER_STEP 2

#endif
