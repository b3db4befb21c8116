// SPDX-License-Identifier: Apache-2.0
// No surface at all: what arrives passes straight on. Mitsuba's `null`.
#ifndef NEARLIGHT_LIB_BSDF_NULL
#define NEARLIGHT_LIB_BSDF_NULL

#include "lib/bsdf/bsdf_types.cl"

static inline BsdfSample null_sample(float3 wo) {
    BsdfSample sample = no_bsdf_sample();
    sample.wi = -wo;
    sample.weight = (float3)(1.0f);
    sample.is_delta = 1;
    sample.is_straight = 1;
    return sample;
}

#endif
