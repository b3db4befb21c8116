// SPDX-License-Identifier: Apache-2.0
// Film: adds the samples of a band to its pixels, and turns sums into the layers of the picture.
//
// One work-item a pixel of the band; any work-group size. `sums` holds FILM_CHANNELS floats a pixel, row by
// row. Samples are added one after the other in their order, so that batches give the same bits as one run.

#include "lib/math.cl"

#define FILM_CHANNELS NEARLIGHT_FILM_CHANNELS

kernel void film_add(const global ReceiverPacket* restrict receivers,
                     const global CameraVertex* restrict vertices,
                     const global IrradiancePacket* restrict direct,
                     const global IrradiancePacket* restrict indirect, uint width, uint row_count,
                     uint sample_count, uint branch_count, global float* restrict sums) {
    const uint index = (uint)get_global_id(0);
    if (index >= width * row_count) {
        return;
    }
    const uint x = index % width;
    const uint y = index / width;
    const uint tile = y / 8 * ((width + 7) / 8) + x / 8;
    const uint lane = y % 8 * 8 + x % 8;
    global float* pixel = sums + (size_t)index * FILM_CHANNELS;
    for (uint i = 0; i < sample_count * branch_count; ++i) {
        const uint packet = tile * sample_count * branch_count + i;
        const CameraVertex vertex = vertices[packet * NEARLIGHT_PACKET_SIZE + lane];
        const float3 reflectance = load3(vertex.throughput) * load3(vertex.albedo);
        const float3 response = reflectance / M_PI_F;
        const float3 e_direct =
            (float3)(direct[packet].r[lane], direct[packet].g[lane], direct[packet].b[lane]);
        const float3 e_indirect =
            (float3)(indirect[packet].r[lane], indirect[packet].g[lane], indirect[packet].b[lane]);
        const float3 direct_radiance = load3(vertex.emitted) + response * e_direct;
        const float3 indirect_radiance = response * e_indirect;
        pixel[0] += direct_radiance.x;
        pixel[1] += direct_radiance.y;
        pixel[2] += direct_radiance.z;
        pixel[3] += indirect_radiance.x;
        pixel[4] += indirect_radiance.y;
        pixel[5] += indirect_radiance.z;
        pixel[6] += reflectance.x;
        pixel[7] += reflectance.y;
        pixel[8] += reflectance.z;
        if (i % branch_count != 0) {
            continue;  // geometry layers show the way straight on
        }
        pixel[9] += receivers[packet].nx[lane];
        pixel[10] += receivers[packet].ny[lane];
        pixel[11] += receivers[packet].nz[lane];
        // Positions and depths cannot be averaged across an edge: the first sample that met something counts.
        if (pixel[15] == 0.0f && vertex.depth > 0.0f) {
            pixel[12] = receivers[packet].px[lane];
            pixel[13] = receivers[packet].py[lane];
            pixel[14] = receivers[packet].pz[lane];
            pixel[15] = vertex.depth;
        }
        pixel[16] += vertex.flags & NEARLIGHT_VERTEX_CLOSE ? 1.0f : 0.0f;
    }
}

/// Output per pixel: beauty, direct, indirect, albedo, N, P, depth, closerange (NEARLIGHT_LAYER_CHANNELS
/// floats).
kernel void film_resolve(const global float* restrict sums, uint pixel_count, uint sample_count,
                         global float* restrict layers) {
    const uint index = (uint)get_global_id(0);
    if (index >= pixel_count) {
        return;
    }
    const global float* sum = sums + (size_t)index * FILM_CHANNELS;
    global float* out = layers + (size_t)index * NEARLIGHT_LAYER_CHANNELS;
    const float scale = 1.0f / (float)sample_count;
    for (uint c = 0; c < 3; ++c) {
        out[c] = (sum[c] + sum[3 + c]) * scale;
        out[3 + c] = sum[c] * scale;
        out[6 + c] = sum[3 + c] * scale;
        out[9 + c] = sum[6 + c] * scale;
        out[15 + c] = sum[12 + c];
    }
    const float3 n = (float3)(sum[9], sum[10], sum[11]);
    const float squared = dot(n, n);
    const float3 unit_n = squared > 0.0f ? n * rsqrt(squared) : n;
    out[12] = unit_n.x;
    out[13] = unit_n.y;
    out[14] = unit_n.z;
    out[18] = sum[15];
    out[19] = sum[16] * scale;
}
