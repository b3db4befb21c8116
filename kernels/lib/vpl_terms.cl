// SPDX-License-Identifier: Apache-2.0
// What a VPL sends to receivers, visibility aside: what the gathers, roulette and the contributions of VPLs
// share.
#ifndef NEARLIGHT_LIB_VPL_TERMS
#define NEARLIGHT_LIB_VPL_TERMS

#include "lib/bundle.cl"
#include "lib/math.cl"

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
