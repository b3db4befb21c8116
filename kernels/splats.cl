// SPDX-License-Identifier: Apache-2.0
// Splats: samples count in all pixels whose reconstruction filter reaches them. So a pixel is the mean of far
// more samples than its own, and has a fraction of their variance: 4/9 with a tent, under a third with a
// Gaussian.
//
// Samples are spread evenly over their pixel and weighted by their area (lib/camera.cl). Each pixel keeps
// sums of its own samples for every pixel that they reach, weighted by the filter of that one: splat_rows()²
// splats, row by row. Pixels of a row then add up what the row has for them, and for the rows around it
// (splats_gather). The host adds up the rows (host/session/splat_rows.h), because they come from several
// bands and devices, and divides by the sum of the weights. So no bit depends on how a picture is divided.
//
// One work-item for each pixel, row by row, or for each listed one; any work-group size. Samples are added in
// their order, so that several batches give the same bits as one.

#include "lib/film_light.cl"
#include "lib/math.cl"
#include "shared/splats.h"

#define MAX_SPLAT_COLUMNS (2 * NEARLIGHT_MAX_SPLAT_REACH + 1)

/// The filter at the middles of the pixels that a sample reaches along one axis, in 1/pixel and scaled so
/// that its integral is 1.
static inline void filter_weights(const global Camera* camera, float offset, float* weights) {
    const int reach = (int)camera->splat_reach;
    const global float* integral = camera->filter_signed;
    const float scale =
        NEARLIGHT_FILTER_CELLS / (2.0f * camera->filter_radius * integral[NEARLIGHT_FILTER_CELLS]);
    for (int i = -reach; i <= reach; ++i) {
        const float place = fabs(offset - (float)i) / camera->filter_radius * NEARLIGHT_FILTER_CELLS;
        const uint cell = (uint)fmin(place, (float)NEARLIGHT_FILTER_CELLS);
        weights[i + reach] =
            cell < NEARLIGHT_FILTER_CELLS ? scale * (integral[cell + 1] - integral[cell]) : 0.0f;
    }
}

/// The filter's weights of a sample, at the middles of the pixels that it reaches.
typedef struct SplatWeights {
    float x[MAX_SPLAT_COLUMNS], y[MAX_SPLAT_COLUMNS];  // the latter times the weight of the sample
} SplatWeights;

static inline SplatWeights weights_of(const global Camera* camera, const global CameraVertex* vertex) {
    SplatWeights weights;
    filter_weights(camera, vertex->film_x, weights.x);
    filter_weights(camera, vertex->film_y, weights.y);
    for (uint i = 0; i < splat_rows(camera->splat_reach); ++i) {
        weights.y[i] *= vertex->filter_weight;
    }
    return weights;
}

static inline void add_to_splat(global Splat* splat, const FilmLight* light, bool is_covered, float weight,
                                bool in_first) {
    const float3 direct = weight * light->direct;
    const float3 indirect = weight * light->indirect;
    splat->direct = store3(load3(splat->direct) + direct);
    splat->indirect = store3(load3(splat->indirect) + indirect);
    splat->weight += weight;
    splat->coverage += is_covered ? weight : 0.0f;
    if (in_first) {
        splat->half_light = store3(load3(splat->half_light) + (direct + indirect));
        splat->half_weight += weight;
    }
}

/// Adds the samples of a batch. The first half of the samples ends before number `half_end`. The light that
/// camera paths bring on their own is left out unless `with_camera_light` is 1.
kernel void splats_add(const global CameraVertex* restrict vertices,
                       const global IrradiancePacket* restrict direct,
                       const global IrradiancePacket* restrict gathered,
                       const global IrradiancePacket* restrict indirect, const global Camera* restrict camera,
                       uint width, uint row_count, PacketOrder order, uint first_sample, uint half_end,
                       uint with_camera_light, global Splat* restrict splats) {
    const uint index = (uint)get_global_id(0);
    if (index >= width * row_count) {
        return;
    }
    const PixelPlace place = place_of_pixel(order, index % width, index / width);
    const uint columns = splat_rows(camera->splat_reach);
    global Splat* own = splats + (size_t)index * columns * columns;
    for (uint sample = 0; sample < order.sample_count; ++sample) {
        const global CameraVertex* first = vertex_at(vertices, order, place, sample, 0);
        const SplatWeights weights = weights_of(camera, first);
        FilmLight light = {(float3)(0.0f), (float3)(0.0f)};
        for (uint branch = 0; branch < order.branch_count; ++branch) {
            const uint packet = packet_at(order, place.column, place.row, sample, branch);
            CameraVertex vertex = *vertex_at(vertices, order, place, sample, branch);
            if (!with_camera_light) {
                vertex.camera_light = store3((float3)(0.0f));
            }
            const FilmLight received =
                received_by(direct + packet, gathered + packet, indirect + packet, place.lane);
            const FilmLight more = branch_light(&vertex, &received, 1.0f);
            light.direct += more.direct;
            light.indirect += more.indirect;
        }
        for (uint i = 0; i < columns * columns; ++i) {
            const float weight = weights.x[i % columns] * weights.y[i / columns];
            add_to_splat(own + i, &light, first->depth > 0.0f, weight, first_sample + sample < half_end);
        }
    }
}

static inline void add_to_camera_splat(global CameraSplat* splat, float3 light, float weight, bool in_first) {
    if (in_first) {
        splat->first = store3(load3(splat->first) + weight * light);
        splat->first_weight += weight;
    } else {
        splat->second = store3(load3(splat->second) + weight * light);
        splat->second_weight += weight;
    }
}

/// Adds the light that the camera paths of a batch bring on their own. The first half of the samples ends
/// before number `half_end`.
kernel void splats_add_camera_light(const global CameraVertex* restrict vertices,
                                    const global Camera* restrict camera, uint width, uint row_count,
                                    PacketOrder order, uint first_sample, uint half_end,
                                    global CameraSplat* restrict splats) {
    const uint index = (uint)get_global_id(0);
    if (index >= width * row_count) {
        return;
    }
    const PixelPlace place = place_of_pixel(order, index % width, index / width);
    const uint columns = splat_rows(camera->splat_reach);
    global CameraSplat* own = splats + (size_t)index * columns * columns;
    for (uint sample = 0; sample < order.sample_count; ++sample) {
        const SplatWeights weights = weights_of(camera, vertex_at(vertices, order, place, sample, 0));
        float3 light = (float3)(0.0f);
        for (uint branch = 0; branch < order.branch_count; ++branch) {
            light += load3(vertex_at(vertices, order, place, sample, branch)->camera_light);
        }
        for (uint i = 0; i < columns * columns; ++i) {
            const float weight = weights.x[i % columns] * weights.y[i / columns];
            add_to_camera_splat(own + i, light, weight, first_sample + sample < half_end);
        }
    }
}

/// Averages the camera light of the listed pixels `first` to `first` + `count` with `added`, what further
/// camera paths brought to them. These are 1/scale times as many as those before any round of
/// camera_lights.cl.
kernel void splats_refine(const global uint* restrict pixels, uint first, uint count, uint reach,
                          const global CameraSplat* restrict added, float scale,
                          global CameraSplat* restrict splats) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    const uint each = splat_rows(reach) * splat_rows(reach);
    const global CameraSplat* more = added + (size_t)index * each;
    global CameraSplat* own = splats + (size_t)pixels[first + index] * each;
    for (uint i = 0; i < each; ++i) {
        own[i].first = store3(0.5f * (load3(own[i].first) + scale * load3(more[i].first)));
        own[i].second = store3(0.5f * (load3(own[i].second) + scale * load3(more[i].second)));
        own[i].first_weight = 0.5f * (own[i].first_weight + scale * more[i].first_weight);
        own[i].second_weight = 0.5f * (own[i].second_weight + scale * more[i].second_weight);
    }
}

static inline void add_splat(Splat* sum, const global Splat* more) {
    sum->direct = store3(load3(sum->direct) + load3(more->direct));
    sum->indirect = store3(load3(sum->indirect) + load3(more->indirect));
    sum->half_light = store3(load3(sum->half_light) + load3(more->half_light));
    sum->weight += more->weight;
    sum->half_weight += more->half_weight;
    sum->coverage += more->coverage;
}

static inline void add_camera_splat(CameraSplat* sum, const global CameraSplat* more) {
    sum->first = store3(load3(sum->first) + load3(more->first));
    sum->second = store3(load3(sum->second) + load3(more->second));
    sum->first_weight += more->first_weight;
    sum->second_weight += more->second_weight;
}

static inline RowSplat no_splat(void) {
    RowSplat row;
    row.all.direct = row.all.indirect = row.all.half_light = store3((float3)(0.0f));
    row.all.weight = row.all.half_weight = row.all.coverage = 0.0f;
    row.camera.first = row.camera.second = store3((float3)(0.0f));
    row.camera.first_weight = row.camera.second_weight = 0.0f;
    return row;
}

/// Adds up what the pixels of each row bring to the pixels of one column, in their own row and in those
/// around it: splat_rows(reach) results for each pixel, the first for the row `reach` above its own.
/// `camera_splats` count only if `with_camera_splats` is 1.
kernel void splats_gather(const global Splat* restrict splats,
                          const global CameraSplat* restrict camera_splats, uint with_camera_splats,
                          uint width, uint row_count, uint reach, global RowSplat* restrict rows) {
    const uint index = (uint)get_global_id(0);
    if (index >= width * row_count) {
        return;
    }
    const int x = (int)(index % width);
    const int columns = (int)splat_rows(reach);
    for (int dy = 0; dy < columns; ++dy) {
        RowSplat sum = no_splat();
        for (int dx = columns - 1; dx >= 0; --dx) {
            const int from = x + (int)reach - dx;  // the pixel for which x is dx − reach to the right
            if (from < 0 || from >= (int)width) {
                continue;
            }
            const size_t at = ((size_t)(index - (uint)x + (uint)from) * columns + dy) * columns + dx;
            add_splat(&sum.all, splats + at);
            if (with_camera_splats) {
                add_camera_splat(&sum.camera, camera_splats + at);
            }
        }
        rows[(size_t)index * columns + dy] = sum;
    }
}
