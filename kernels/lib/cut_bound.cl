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
    float16 nx, ny, nz;  // means of the normals
    float16 spread;      // max distance of a normal from the mean
    float16 share;       // the cluster's receivers ÷ those of the bundle; 0: it has none
} BundleClusters;

/// A node or a single VPL.
typedef struct Emission {
    float3 center;
    float radius;
    float3 axis;
    float spread, power;
} Emission;

// Cosines of a cluster and a node are estimated as their mean plus this part of their uncertainty.
#ifndef CUT_UNCERTAINTY
#define CUT_UNCERTAINTY 0.25f
#endif
// Distances of a cluster and a node count as at least this part of their radii.
#ifndef CUT_NEARNESS
#define CUT_NEARNESS 0.25f
#endif
// The minimum cosine of a cluster and a node that may see each other.
#ifndef CUT_MIN_COSINE
#define CUT_MIN_COSINE 0.05f
#endif

/// The receivers of 16 lanes of a packet.
inline void add_cluster(BundleClusters* clusters, uint index, const global ReceiverPacket* packet,
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
    float radius = 0.0f, spread = 0.0f;
    for (uint lane = first_lane; lane < first_lane + 16; ++lane) {
        const float3 n = receiver_normal(packet, lane);
        if (dot(n, n) > 0.0f) {
            radius = fmax(radius, distance(center, receiver_position(packet, lane)));
            spread = fmax(spread, distance(normal, n));
        }
    }
    // Rounding must not take away what lies on the horizon.
    const float slack = 1e-5f;
    ((float*)&clusters->x)[index] = center.x;
    ((float*)&clusters->y)[index] = center.y;
    ((float*)&clusters->z)[index] = center.z;
    ((float*)&clusters->radius)[index] = radius + slack * (radius + max_component(fabs(center)));
    ((float*)&clusters->nx)[index] = normal.x;
    ((float*)&clusters->ny)[index] = normal.y;
    ((float*)&clusters->nz)[index] = normal.z;
    ((float*)&clusters->spread)[index] = spread + slack;
    ((float*)&clusters->share)[index] = (float)count;
}

inline BundleClusters clusters_of(const global ReceiverPacket* packets, const Bundle* bundle) {
    BundleClusters clusters;
    clusters.share = (float16)0.0f;
    clusters.x = clusters.y = clusters.z = clusters.radius = (float16)0.0f;
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

inline Emission emission_of_node(const global CutNode* node) {
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

/// The estimated mean over the bundle's receivers of the light that VPLs could bring. It is 0 only where none
/// of them brings any: cosines are estimated from the centres of spheres, and numerators are greater by at
/// most the radii, and by the spread of normals times the distance, for any pair of points in the spheres.
inline float cut_bound(const BundleClusters* clusters, const Emission* from, float clamp_radius_squared) {
    const float16 dx = from->center.x - clusters->x;
    const float16 dy = from->center.y - clusters->y;
    const float16 dz = from->center.z - clusters->z;
    const float16 squared = dx * dx + dy * dy + dz * dz;
    const float16 distance = sqrt(squared);
    const float16 radius = clusters->radius + from->radius;
    const float16 to_receiver = clusters->nx * dx + clusters->ny * dy + clusters->nz * dz;
    const float16 from_vpl = -(from->axis.x * dx + from->axis.y * dy + from->axis.z * dz);
    const float16 receiver_slack = radius + clusters->spread * (distance + radius);
    const float16 vpl_slack = radius + from->spread * (distance + radius);
    const int16 open = (to_receiver + receiver_slack > 0.0f) & (from_vpl + vpl_slack > 0.0f);
    const float16 scale = 1.0f / fmax(distance, (float16)1e-30f);
    const float16 receiver_cosine =
        clamp((to_receiver + CUT_UNCERTAINTY * receiver_slack) * scale, CUT_MIN_COSINE, 1.0f);
    const float16 vpl_cosine = clamp((from_vpl + CUT_UNCERTAINTY * vpl_slack) * scale, CUT_MIN_COSINE, 1.0f);
    const float16 nearness = CUT_NEARNESS * radius;
    const float16 least = fmax(fmax(nearness * nearness, (float16)clamp_radius_squared), (float16)1e-30f);
    const float16 term = receiver_cosine * vpl_cosine / fmax(squared, least);
    const float16 terms = open ? clusters->share * term : (float16)0.0f;
    const float8 a = terms.lo + terms.hi;
    const float4 b = a.lo + a.hi;
    return from->power * (b.x + b.y + b.z + b.w);
}

#endif
