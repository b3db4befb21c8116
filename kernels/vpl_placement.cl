// SPDX-License-Identifier: Apache-2.0
// Even placement: K points over the area of the selected triangles, one in each of K equal parts of it. Large
// triangles get many points, and runs of small ones share one. Where the policy decides point by point, only
// the part of a triangle in the close range counts and gets points. [paper section 3: placement by the area
// prefix sum]
//
// Areas are fixed-point numbers (ulong), so that their sums are exact and a point falls on the same triangle
// on every device. Part k of K is [floor(k·A/K), floor((k + 1)·A/K)) of the summed area A, in integers. A
// triangle whose area rounds to zero is never chosen.
//
// Memory: `ids` lists the selected triangles, `area_sums` (inclusive) their areas up to and including each.
// One work-item for each element; work-group size: any.

#include "lib/close_part.cl"
#include "lib/math.cl"
#include "lib/random.cl"
#include "lib/sampling.cl"

#define PLACEMENT_DIMENSION 0x506c6163u

/// Writes the areas of the selected triangles in units of 1/scale m²; `scale` is a power of two.
kernel void placement_areas(const global float* restrict areas, const global uint* restrict ids,
                            global ulong* restrict fixed_areas, float scale, uint count) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    fixed_areas[i] = convert_ulong_sat_rte(areas[ids[i]] * scale);
}

/// Where part `k` of `part_count` begins: floor(k · total / part_count), without overflow.
static inline ulong part_begin(uint k, uint part_count, ulong total) {
    return k * (total / part_count) + k * (total % part_count) / part_count;
}

/// The first of `count` triangles whose sum exceeds `at`, which must be less than the last sum.
static inline uint find_triangle(const global ulong* restrict area_sums, uint count, ulong at) {
    uint low = 0;
    uint high = count - 1;
    while (low < high) {
        const uint middle = low + (high - low) / 2;
        if (area_sums[middle] > at) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

static inline SurfaceSample sample_on_triangle(const global Vertex* restrict vertices, Triangle triangle,
                                               uint triangle_id, float2 weights) {
    const global Vertex* a = vertices + triangle.v0;
    const global Vertex* b = vertices + triangle.v1;
    const global Vertex* c = vertices + triangle.v2;
    const float3 edge1 = load3(b->position) - load3(a->position);
    const float3 edge2 = load3(c->position) - load3(a->position);
    const float3 normal = cross(edge1, edge2);
    SurfaceSample sample;
    sample.position = store3(load3(a->position) + weights.x * edge1 + weights.y * edge2);
    sample.triangle = triangle_id;
    sample.normal = store3(normal / sqrt(dot(normal, normal)));
    sample.u = weights.x;
    sample.v = weights.y;
    sample.pad0 = 0.0f;
    sample.pad1 = 0.0f;
    sample.pad2 = 0.0f;
    return sample;
}

/// Places point k of `sample_count`, one in each work-item.
kernel void place_samples(const global Vertex* restrict vertices, const global Triangle* restrict triangles,
                          const global uint* restrict ids, const global ulong* restrict area_sums,
                          const global CloseRange* restrict close_range, uint whole_triangles,
                          global SurfaceSample* restrict samples, uint triangle_count, uint sample_count,
                          uint seed) {
    const uint k = (uint)get_global_id(0);
    if (k >= sample_count) {
        return;
    }
    const ulong total = area_sums[triangle_count - 1];
    const ulong begin = part_begin(k, sample_count, total);
    const ulong size = part_begin(k + 1, sample_count, total) - begin;
    const uint4 random = random_uint4((uint4)(k, seed, PLACEMENT_DIMENSION, 0));
    const ulong at = begin + mul_hi((ulong)random.x << 32 | random.y, size);
    const uint id = ids[find_triangle(area_sums, triangle_count, at)];
    // Neighbours in k share large triangles; a (0, 2)-sequence spreads them evenly there too.
    const float2 u = sample_2d(k, PLACEMENT_DIMENSION, seed);
    const Triangle triangle = triangles[id];
    float2 weights = square_to_triangle(u);
    if (!whole_triangles) {
        const Polygon part =
            close_part(close_range, load3(vertices[triangle.v0].position),
                       load3(vertices[triangle.v1].position), load3(vertices[triangle.v2].position));
        weights = square_to_part(&part, u);
    }
    samples[k] = sample_on_triangle(vertices, triangle, id, weights);
}
