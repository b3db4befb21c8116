// SPDX-License-Identifier: Apache-2.0
// Film: adds the samples of a band to its pixels, and turns sums into the layers of the picture.
//
// One work-item for each pixel of the band; any work-group size. `sums` holds NEARLIGHT_FILM_CHANNELS floats
// for each pixel, row by row. Where samples count in the pixels around theirs, too, splats.cl has the
// light and the coverage instead. Samples are added one after the other in their order, so that several
// batches give the same bits as one. shared/film_layers.h is the table of layers: film_add has a line for
// each of them, and film_resolve goes through the table.

#include "lib/film_light.cl"
#include "lib/halves.cl"
#include "lib/math.cl"
#include "lib/vpl.cl"
#include "shared/film_layers.h"
#include "shared/packet_order.h"

static inline void add_to_sum(global float* sum, float3 v) {
    sum[0] += v.x;
    sum[1] += v.y;
    sum[2] += v.z;
}
static inline void store_channels(global float* channels, float3 v) {
    channels[0] = v.x;
    channels[1] = v.y;
    channels[2] = v.z;
}

/// Whether a sample's position and depth replace the stored ones: the first sample that met something on the
/// pixel's own square has precedence over the first one anywhere, whose depth is stored as negative.
static inline bool is_better_depth(float stored, const CameraVertex* vertex) {
    const bool is_own = (vertex->flags & NEARLIGHT_VERTEX_OWN_PIXEL) != 0;
    return vertex->depth > 0.0f && (stored == 0.0f || (stored < 0.0f && is_own));
}

/// Keeps the light of the samples so far. After the last sample of the first half, this is the half's light.
static inline void keep_light(global float* pixel) {
    for (uint c = 0; c < 3; ++c) {
        pixel[NEARLIGHT_SUM_VARIANCE + c] =
            pixel[NEARLIGHT_SUM_DIRECT + c] + pixel[NEARLIGHT_SUM_INDIRECT + c];
    }
}

/// Adds the light that comes by one branch of a sample. Only light has the filter's weights. Surfaces are
/// averaged over where the samples lie, so that no layer of them overshoots where the filter is negative.
static inline void add_light(global float* pixel, const CameraVertex* vertex, const FilmLight* received) {
    const FilmLight light = branch_light(vertex, received, vertex->filter_weight);
    add_to_sum(pixel + NEARLIGHT_SUM_DIRECT, light.direct);
    add_to_sum(pixel + NEARLIGHT_SUM_INDIRECT, light.indirect);
    add_to_sum(pixel + NEARLIGHT_SUM_ALBEDO, reflectance_of(vertex));
}

/// The normal that a sample shows. A receiver that is absent because its light was traced has it where the
/// mesh's stands (camera_pass.cl).
static inline float3 shown_normal(const global ReceiverPacket* receiver, uint lane) {
    const float3 normal = receiver_normal(receiver, lane);
    return dot(normal, normal) > 0.0f ? normal : receiver_mesh_normal(receiver, lane);
}

/// Adds what the first branch of a sample saw.
static inline void add_surface(global float* pixel, const CameraVertex* vertex,
                               const global ReceiverPacket* receiver, uint lane) {
    add_to_sum(pixel + NEARLIGHT_SUM_NORMAL, shown_normal(receiver, lane));
    if (is_better_depth(pixel[NEARLIGHT_SUM_DEPTH], vertex)) {
        store_channels(pixel + NEARLIGHT_SUM_POSITION,
                       (float3)(receiver->px[lane], receiver->py[lane], receiver->pz[lane]));
        pixel[NEARLIGHT_SUM_DEPTH] =
            vertex->flags & NEARLIGHT_VERTEX_OWN_PIXEL ? vertex->depth : -vertex->depth;
    }
    pixel[NEARLIGHT_SUM_CLOSE_RANGE] += vertex->flags & NEARLIGHT_VERTEX_CLOSE ? 1.0f : 0.0f;
    pixel[NEARLIGHT_SUM_ALPHA] += vertex->depth > 0.0f ? 1.0f : 0.0f;
}

/// Adds the samples of a batch, from number `first_sample` on, of `samples_per_pixel` in all batches.
kernel void film_add(const global ReceiverPacket* restrict receivers,
                     const global CameraVertex* restrict vertices,
                     const global IrradiancePacket* restrict direct,
                     const global IrradiancePacket* restrict gathered,
                     const global IrradiancePacket* restrict indirect, uint width, uint row_count,
                     PacketOrder order, uint first_sample, uint samples_per_pixel,
                     global float* restrict sums) {
    const uint index = (uint)get_global_id(0);
    if (index >= width * row_count) {
        return;
    }
    const PixelPlace place = place_of_pixel(order, index % width, index / width);
    const uint lane = place.lane;
    global float* pixel = sums + (size_t)index * NEARLIGHT_FILM_CHANNELS;
    for (uint sample = 0; sample < order.sample_count; ++sample) {
        for (uint branch = 0; branch < order.branch_count; ++branch) {
            const uint packet = packet_at(order, place.column, place.row, sample, branch);
            const CameraVertex vertex = *vertex_at(vertices, order, place, sample, branch);
            const FilmLight received =
                received_by(direct + packet, gathered + packet, indirect + packet, lane);
            add_light(pixel, &vertex, &received);
            if (first_sample + sample < samples_per_pixel / 2) {
                keep_light(pixel);
            }
            if (branch == 0) {
                add_surface(pixel, &vertex, receivers + packet, lane);
            }
        }
    }
}

// These functions turn the sums of a pixel into a layer of `count` channels. There is one for each word of
// the column `samples` of the table. `first` is where the layer's own sums begin, and `scale` is 1 / samples.
// All have the same parameters, so that the table can name any of them.

static inline void resolve_mean(const global float* sums, uint first, uint count, float scale,
                                global float* layer) {
    for (uint c = 0; c < count; ++c) {
        layer[c] = sums[first + c] * scale;
    }
}
static inline void resolve_first(const global float* sums, uint first, uint count, float scale,
                                 global float* layer) {
    (void)scale;
    for (uint c = 0; c < count; ++c) {
        layer[c] = sums[first + c];
    }
}
static inline void resolve_depth(const global float* sums, uint first, uint count, float scale,
                                 global float* layer) {
    (void)count, (void)scale;
    layer[0] = fabs(sums[first]);
}
static inline void resolve_direction(const global float* sums, uint first, uint count, float scale,
                                     global float* layer) {
    (void)count, (void)scale;
    const float3 n = (float3)(sums[first], sums[first + 1], sums[first + 2]);
    const float squared = dot(n, n);
    store_channels(layer, squared > 0.0f ? n * rsqrt(squared) : n);
}
static inline void resolve_light(const global float* sums, uint first, uint count, float scale,
                                 global float* layer) {
    (void)first;
    for (uint c = 0; c < count; ++c) {
        layer[c] = (sums[NEARLIGHT_SUM_DIRECT + c] + sums[NEARLIGHT_SUM_INDIRECT + c]) * scale;
    }
}

static inline void resolve_spread(const global float* sums, uint first, uint count, float scale,
                                  global float* layer) {
    const uint samples = (uint)rint(1.0f / scale);
    for (uint c = 0; c < count; ++c) {
        const float light = sums[NEARLIGHT_SUM_DIRECT + c] + sums[NEARLIGHT_SUM_INDIRECT + c];
        layer[c] =
            NEARLIGHT_HALVES_TO_WHOLE * variance_by_halves(sums[first + c], light - sums[first + c], samples);
    }
}

#define RESOLVE_LAYER(constant, name, channels, samples, passes, files, storage)             \
    resolve_##samples(pixel, NEARLIGHT_SUM_##constant, NEARLIGHT_CHANNELS_##channels, scale, \
                      out + NEARLIGHT_LAYER_##constant);

/// Writes NEARLIGHT_LAYER_CHANNELS floats for each pixel, in the order of the table.
kernel void film_resolve(const global float* restrict sums, uint pixel_count, uint sample_count,
                         global float* restrict layers) {
    const uint index = (uint)get_global_id(0);
    if (index >= pixel_count) {
        return;
    }
    const global float* pixel = sums + (size_t)index * NEARLIGHT_FILM_CHANNELS;
    global float* out = layers + (size_t)index * NEARLIGHT_LAYER_CHANNELS;
    const float scale = 1.0f / (float)sample_count;
    NEARLIGHT_FILM_LAYERS(RESOLVE_LAYER)
}
