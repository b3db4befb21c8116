// SPDX-License-Identifier: Apache-2.0
// About what VPLs could bring to a bundle of receivers if nothing were in the way.
#ifndef NEARLIGHT_LIB_CUT_BOUND
#define NEARLIGHT_LIB_CUT_BOUND

#include "lib/bundle.cl"
#include "lib/vpl.cl"
#include "shared/light_cut.h"

/// Receivers of a bundle in 16 clusters, each in a lane of its own: those of two rows of a tile's pixels.
typedef struct BundleClusters {
    float16 x, y, z;     // centres
    float16 radius;      // of the sphere that holds the receivers
    float16 thickness;   // max distance of a receiver from the plane of the centre and the mean normal
    float16 nx, ny, nz;  // means of the normals
    float16 spread;      // max distance of a normal from the mean
    float16 share;       // the cluster's receivers ÷ those of the bundle; 0: it has none
} BundleClusters;

/// What the VPLs of a node send out, or a single VPL. The members are those of CutNode.
typedef struct Emission {
    float3 center;
    float radius;
    float3 axis;
    float spread, power;
} Emission;

// Cosines of a cluster and a node are estimated as their mean plus this part of their uncertainty.
#define CUT_UNCERTAINTY 0.1f
// Distances of a cluster and a node count as at least this part of their radii.
#define CUT_NEARNESS 0.25f
// This part of the estimate is an upper bound, so that no light is much stronger than its estimate.
#define CUT_DEFENCE 0.0625f

/// The receivers of 16 lanes of a packet.
static inline void add_cluster(BundleClusters* clusters, uint index, const global ReceiverPacket* packet,
                               uint first_lane) {
    float3 center = (float3)0.0f, normal = (float3)0.0f;
    uint count = 0;
    for (uint lane = first_lane; lane < first_lane + 16; ++lane) {
        const float3 n = receiver_normal(packet, lane);
        if (dot(n, n) > 0.0f) {
            center += receiver_position(packet, lane);
            normal += n;
            ++count;
        }
    }
    const float scale = 1.0f / (float)max(count, 1u);
    center *= scale;
    normal *= scale;
    float radius = 0.0f, thickness = 0.0f, spread = 0.0f;
    for (uint lane = first_lane; lane < first_lane + 16; ++lane) {
        const float3 n = receiver_normal(packet, lane);
        if (dot(n, n) > 0.0f) {
            const float3 way = receiver_position(packet, lane) - center;
            radius = fmax(radius, length(way));
            thickness = fmax(thickness, fabs(dot(way, normal)));
            spread = fmax(spread, distance(normal, n));
        }
    }
    // Rounding must not take away what lies on the horizon.
    const float slack = 1e-5f;
    ((float*)&clusters->x)[index] = center.x;
    ((float*)&clusters->y)[index] = center.y;
    ((float*)&clusters->z)[index] = center.z;
    const float rounding = slack * (radius + max_component(fabs(center)));
    ((float*)&clusters->radius)[index] = radius + rounding;
    ((float*)&clusters->thickness)[index] = thickness + rounding;
    ((float*)&clusters->nx)[index] = normal.x;
    ((float*)&clusters->ny)[index] = normal.y;
    ((float*)&clusters->nz)[index] = normal.z;
    ((float*)&clusters->spread)[index] = spread + slack;
    ((float*)&clusters->share)[index] = (float)count;
}

static inline BundleClusters clusters_of(const global ReceiverPacket* packets, const Bundle* bundle) {
    BundleClusters clusters;
    clusters.share = (float16)0.0f;
    clusters.x = clusters.y = clusters.z = (float16)0.0f;
    clusters.radius = clusters.thickness = (float16)0.0f;
    clusters.nx = clusters.ny = clusters.nz = clusters.spread = (float16)0.0f;
    for (uint i = 0; i < bundle->count; ++i) {
        for (uint row = 0; row < NEARLIGHT_PACKET_SIZE / 16; ++row) {
            add_cluster(&clusters, i * (NEARLIGHT_PACKET_SIZE / 16) + row, packets + bundle->first + i,
                        row * 16);
        }
    }
    float count = 0.0f;
    for (uint i = 0; i < 16; ++i) {
        count += ((const float*)&clusters.share)[i];
    }
    clusters.share = clusters.share / fmax(count, 1.0f);
    return clusters;
}

static inline Emission emission_of_node(const global CutNode* node) {
    const float3 low = load3(node->low);
    const float3 high = load3(node->high);
    Emission emission;
    emission.center = 0.5f * (low + high);
    emission.radius = 0.5f * length(high - low);
    emission.axis = load3(node->axis);
    emission.spread = node->spread;
    emission.power = node->power;
    return emission;
}

/// The bounded geometry term of clusters at a distance, with cosines as numerators: each still has a factor
/// of the distance.
static inline float16 cut_term(float16 distance, float16 to_receiver, float16 from_vpl, float16 min_square) {
    const float16 scale = 1.0f / fmax(distance, (float16)1e-30f);
    return clamp(to_receiver * scale, 0.0f, 1.0f) * clamp(from_vpl * scale, 0.0f, 1.0f) /
           fmax(distance * distance, min_square);
}

/// The estimated mean over the bundle's receivers of the light that VPLs could bring. It is 0 only where none
/// of them brings any: cosines are estimated from the centres of spheres, and numerators are greater by at
/// most the radii, and by the spread of normals times the distance, for any pair of points in the spheres.
static inline float cut_bound(const BundleClusters* clusters, const Emission* from,
                              float clamp_radius_squared) {
    const float16 dx = from->center.x - clusters->x;
    const float16 dy = from->center.y - clusters->y;
    const float16 dz = from->center.z - clusters->z;
    const float16 squared = dx * dx + dy * dy + dz * dz;
    const float16 distance = sqrt(squared);
    const float16 radius = clusters->radius + from->radius;
    const float16 to_receiver = clusters->nx * dx + clusters->ny * dy + clusters->nz * dz;
    const float16 from_vpl = -(from->axis.x * dx + from->axis.y * dy + from->axis.z * dz);
    // By how much numerators of cosines may exceed those of the centres.
    const float16 receiver_slack =
        clusters->thickness + from->radius + clusters->spread * (distance + radius);
    const float16 vpl_slack = radius + from->spread * (distance + radius);
    const int16 open = (to_receiver + receiver_slack > 0.0f) & (from_vpl + vpl_slack > 0.0f);
    // Without a clamp radius, a receiver inside a node's sphere has no bound; this one stays finite.
    const float16 min_square = fmax((float16)clamp_radius_squared, 1e-6f * radius * radius + 1e-18f);
    const float16 usual = cut_term(distance, to_receiver + CUT_UNCERTAINTY * receiver_slack,
                                   from_vpl + CUT_UNCERTAINTY * vpl_slack,
                                   fmax(CUT_NEARNESS * CUT_NEARNESS * radius * radius, min_square));
    const float16 max_term = cut_term(fmax(distance - radius, (float16)0.0f), to_receiver + receiver_slack,
                                      from_vpl + vpl_slack, min_square);
    const float16 term = (1.0f - CUT_DEFENCE) * usual + CUT_DEFENCE * max_term;
    const float16 terms = open ? clusters->share * term : (float16)0.0f;
    const float8 a = terms.lo + terms.hi;
    const float4 b = a.lo + a.hi;
    return from->power * (b.x + b.y + b.z + b.w);
}

#endif
