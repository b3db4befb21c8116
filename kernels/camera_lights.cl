// SPDX-License-Identifier: Apache-2.0
// Camera light: what the camera paths of a pixel bring on their own, and which pixels need more of these
// paths.
//
// This light needs no gather, so a path costs a fraction of a sample. Most of its noise is in few pixels: at
// edges of windows and lamps, of their images in mirrors, and of highlights. These get further camera paths,
// in up to NEARLIGHT_MAX_ROUNDS rounds, each of which doubles the paths of its pixels. The mean over all
// paths then takes the place of the mean over the first ones in the sums of the film.
//
// A pixel's neighbours decide how many rounds it gets, never its own samples, which keeps its mean unbiased:
// a pixel that missed a lamp by chance must not be left alone for that. Neighbours are those in the same
// square of NEARLIGHT_TILE_SIZE pixels, so that no bit depends on how the picture is divided into bands. One
// work-item for each pixel; any work-group size.

#include "lib/film_light.cl"
#include "lib/halves.cl"
#include "lib/math.cl"
#include "shared/camera_pass.h"
#include "shared/film_layers.h"
#include "shared/packet_order.h"

/// Adds the samples of a batch at all its places, row by row. The first half of the samples ends before
/// number `half_end`.
kernel void camera_lights_add(const global CameraVertex* restrict vertices, uint width, uint row_count,
                              PacketOrder order, uint first_sample, uint half_end,
                              global CameraLight* restrict lights) {
    const uint index = (uint)get_global_id(0);
    if (index >= width * row_count) {
        return;
    }
    const PixelPlace place = place_of_pixel(order, index % width, index / width);
    float3 halves[2] = {load3(lights[index].first), load3(lights[index].second)};
    for (uint sample = 0; sample < order.sample_count; ++sample) {
        for (uint branch = 0; branch < order.branch_count; ++branch) {
            const global CameraVertex* vertex = vertex_at(vertices, order, place, sample, branch);
            halves[first_sample + sample >= half_end] += vertex->filter_weight * load3(vertex->camera_light);
        }
    }
    lights[index].first = store3(halves[0]);
    lights[index].second = store3(halves[1]);
}

/// The variance of the mean of a pixel's camera light, over all channels.
static inline float variance_of_mean(const global CameraLight* light, uint sample_count) {
    return variance_by_halves(light->first.x, light->second.x, sample_count) +
           variance_by_halves(light->first.y, light->second.y, sample_count) +
           variance_by_halves(light->first.z, light->second.z, sample_count);
}

/// The square of all light of a pixel.
static inline float squared_light(const global float* sums, uint sample_count) {
    const global float* direct = sums + NEARLIGHT_SUM_DIRECT;
    const global float* indirect = sums + NEARLIGHT_SUM_INDIRECT;
    const float3 light = (float3)(direct[0] + indirect[0], direct[1] + indirect[1], direct[2] + indirect[2]) /
                         (float)sample_count;
    return dot(light, light);
}

/// What is added to the squared light of each pixel, as a part of the mean of its neighbours: the dark side
/// of an edge must not outweigh the rest.
#define ADDED_PART 0.01f

/// The mean of the relative variances of `count` pixels, of one sample each.
static inline float relative_variance(const float* variances, const float* squares, uint count,
                                      uint sample_count) {
    float added = 0.0f;
    for (uint i = 0; i < count; ++i) {
        added += ADDED_PART * squares[i] / (float)count;
    }
    float sum = 0.0f;
    for (uint i = 0; i < count; ++i) {
        sum += variances[i] > 0.0f ? variances[i] / (squares[i] + added) : 0.0f;
    }
    return count > 0 ? sum * (float)sample_count / (float)count : 0.0f;
}

/// How many rounds a pixel gets, for the relative variance of its neighbours. The least error for the time is
/// that of samples in proportion to the root of the variance.
static inline uint rounds_of(float variance) {
    if (!(variance > NEARLIGHT_ENOUGH_VARIANCE)) {
        return 0;
    }
    return (uint)fmin(rint(0.5f * log2(variance / NEARLIGHT_ENOUGH_VARIANCE)), (float)NEARLIGHT_MAX_ROUNDS);
}

/// Writes for each pixel how many rounds it gets, after `sample_count` samples of each, at least two.
kernel void camera_lights_rounds(const global CameraLight* restrict lights, const global float* restrict sums,
                                 uint width, uint row_count, uint sample_count,
                                 global uint* restrict rounds) {
    const uint index = (uint)get_global_id(0);
    if (index >= width * row_count) {
        return;
    }
    const uint x = index % width;
    const uint y = index / width;
    const uint square_x = x / NEARLIGHT_TILE_SIZE * NEARLIGHT_TILE_SIZE;
    const uint square_y = y / NEARLIGHT_TILE_SIZE * NEARLIGHT_TILE_SIZE;
    const uint last_x = min(min(x + 1, square_x + NEARLIGHT_TILE_SIZE - 1), width - 1);
    const uint last_y = min(min(y + 1, square_y + NEARLIGHT_TILE_SIZE - 1), row_count - 1);
    float variances[8], squares[8];
    uint count = 0;
    for (uint row = y > square_y ? y - 1 : y; row <= last_y; ++row) {
        for (uint column = x > square_x ? x - 1 : x; column <= last_x; ++column) {
            const uint other = row * width + column;
            if (other != index) {
                variances[count] = variance_of_mean(lights + other, sample_count);
                squares[count] = squared_light(sums + (size_t)other * NEARLIGHT_FILM_CHANNELS, sample_count);
                ++count;
            }
        }
    }
    rounds[index] = rounds_of(relative_variance(variances, squares, count, sample_count));
}

/// Adds the samples of one round to the listed pixels `first` to `first` + `count`. `added` has what they
/// bring, `scale` is the samples of a pixel before any round ÷ those after this one. Changes the sums of the
/// film accordingly, and counts the round.
kernel void camera_lights_refine(const global uint* restrict pixels, uint first, uint count,
                                 const global CameraLight* restrict added, float scale,
                                 global CameraLight* restrict lights, global float* restrict sums,
                                 global uint* restrict rounds) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    const uint pixel = pixels[first + index];
    global CameraLight* light = lights + pixel;
    global float* sum = sums + (size_t)pixel * NEARLIGHT_FILM_CHANNELS;
    const float3 before[2] = {load3(light->first), load3(light->second)};
    const float3 more[2] = {load3(added[index].first), load3(added[index].second)};
    // The film's sum, over as many samples as before any round, is (before + more) · scale now, and it was
    // before · 2 · scale.
    const float3 of_first = scale * (more[0] - before[0]);
    const float3 change = of_first + scale * (more[1] - before[1]);
    const float changes[3] = {change.x, change.y, change.z};
    const float first_changes[3] = {of_first.x, of_first.y, of_first.z};
    for (uint c = 0; c < 3; ++c) {
        sum[NEARLIGHT_SUM_DIRECT + c] += changes[c];
        sum[NEARLIGHT_SUM_VARIANCE + c] += first_changes[c];
    }
    light->first = store3(before[0] + more[0]);
    light->second = store3(before[1] + more[1]);
    rounds[pixel] -= 1;
}
