// SPDX-License-Identifier: Apache-2.0
// The random numbers of a receiver's path.
#ifndef NEARLIGHT_LIB_PATH_NUMBERS
#define NEARLIGHT_LIB_PATH_NUMBERS

#include "lib/random.cl"

/// The random numbers of a path at one surface.
typedef struct PathNumbers {
    float model;  // for masks and blends
    float way;    // how a path goes on from its first surface (choose_continuation())
    float lobe;   // within S
    float2 direction;
    float end;              // whether the path ends by chance
    float of_bundle, draw;  // whether a path becomes the bundle's, and whether its light is drawn
    uint light_seed;
} PathNumbers;

/// The numbers at the surface number `surfaces`, from 1 on, of the path with these keys.
static inline PathNumbers path_numbers(uint4 keys, uint surfaces) {
    const uint4 random = random_uint4((uint4)(keys.y, keys.z, keys.w, surfaces));
    const uint4 more = random_uint4((uint4)(random.x, keys.x, surfaces, 0x5ca77e4u));
    const uint4 of_bundle = random_uint4(more ^ 0xd4a35u);
    PathNumbers numbers;
    numbers.model = to_unit_float(more.x);
    numbers.way = to_unit_float(more.w);
    numbers.lobe = to_unit_float(more.y);
    numbers.direction = (float2)(to_unit_float(random.y), to_unit_float(random.z));
    numbers.end = to_unit_float(more.z);
    numbers.of_bundle = to_unit_float(of_bundle.x);
    numbers.draw = to_unit_float(of_bundle.y);
    numbers.light_seed = random.w;
    return numbers;
}

#endif
