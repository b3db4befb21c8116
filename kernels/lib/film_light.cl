// SPDX-License-Identifier: Apache-2.0
// The samples of a pixel, and the light that one branch of a sample brings to it.
#ifndef NEARLIGHT_LIB_FILM_LIGHT
#define NEARLIGHT_LIB_FILM_LIGHT

#include "lib/math.cl"
#include "shared/packet_order.h"
#include "shared/types.h"

/// What the camera pass wrote for a branch of a sample of the pixel at a place.
static inline const global CameraVertex* vertex_at(const global CameraVertex* vertices, PacketOrder order,
                                                   PixelPlace place, uint sample, uint branch) {
    const uint packet = packet_at(order, place.column, place.row, sample, branch);
    return vertices + (size_t)packet * NEARLIGHT_PACKET_SIZE + place.lane;
}

static inline float3 irradiance_of(const global IrradiancePacket* packet, uint lane) {
    return (float3)(packet->r[lane], packet->g[lane], packet->b[lane]);
}

/// Light of a receiver (irradiance, W/m²) or of a sample (radiance, W/m²/sr).
typedef struct FilmLight {
    float3 direct, indirect;
} FilmLight;

/// What reaches the receiver of a branch.
static inline FilmLight received_by(const global IrradiancePacket* direct,
                                    const global IrradiancePacket* gathered,
                                    const global IrradiancePacket* indirect, uint lane) {
    const FilmLight light = {irradiance_of(direct, lane),
                             irradiance_of(gathered, lane) + irradiance_of(indirect, lane)};
    return light;
}

/// The part of the light on its receiver that a branch sends to the camera.
static inline float3 reflectance_of(const CameraVertex* vertex) {
    return load3(vertex->throughput) * load3(vertex->albedo);
}

/// The light of a branch, times a weight.
static inline FilmLight branch_light(const CameraVertex* vertex, const FilmLight* received, float weight) {
    const float3 response = weight * reflectance_of(vertex) / M_PI_F;
    const float3 direct = load3(vertex->camera_light) + load3(vertex->traced_direct);
    const FilmLight light = {weight * direct + response * received->direct,
                             weight * load3(vertex->traced_indirect) + response * received->indirect};
    return light;
}

#endif
