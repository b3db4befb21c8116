// SPDX-License-Identifier: Apache-2.0
// The receivers of a beam: loaded once, put in order so that neighbours form clusters, and bounded by boxes.
#ifndef NEARLIGHT_LIB_BEAM_RECEIVERS
#define NEARLIGHT_LIB_BEAM_RECEIVERS

#include "lib/bundle.cl"
#include "lib/lanes.cl"
#include "lib/map_shadowing.cl"
#include "lib/vpl.cl"

// GATHER_BEAM_WIDTH receivers go through the tree together: 16, 32, 64, 128 or 256, in rows of 16 lanes. They
// form 16 clusters, each of neighbouring lanes of one row.
#ifndef GATHER_BEAM_WIDTH
#define GATHER_BEAM_WIDTH BUNDLE_RECEIVERS
#endif
#define GATHER_ROWS (GATHER_BEAM_WIDTH / 16)
#define CLUSTERS 16
#define CLUSTER_SIZE (GATHER_BEAM_WIDTH / CLUSTERS)
#define ROW_CLUSTERS (CLUSTERS / GATHER_ROWS)

typedef struct Receivers {
    float16 x[GATHER_ROWS], y[GATHER_ROWS], z[GATHER_ROWS];
    float16 nx[GATHER_ROWS], ny[GATHER_ROWS], nz[GATHER_ROWS];
    float16 threshold[GATHER_ROWS];   // for squared light, which is left out below it; see load_thresholds()
    ushort curve[GATHER_BEAM_WIDTH];  // rows of transmission curves; see load_curves()
    uint curved_rows;                 // one bit for each row of 16 lanes that has a curve
    // Normals of the mesh and the squared α of what shadows a map makes; see load_maps().
    float16 mesh_x[GATHER_ROWS], mesh_y[GATHER_ROWS], mesh_z[GATHER_ROWS], map_tilt[GATHER_ROWS];
    uint mapped_rows;                // one bit for each row of 16 lanes that has a map
    uchar order[GATHER_BEAM_WIDTH];  // receiver of each lane, counted from the first of the beam
} Receivers;

/// The box around all receivers that are present, and the box around each cluster in a lane of its own (x, y,
/// z).
typedef struct BeamBounds {
    float3 low, high;
    float16 cluster_low[3], cluster_high[3];
} BeamBounds;

/// The positions of the receivers, lane by lane. They are +∞ where a receiver is absent or not finite,
/// because such a receiver is culled and must not widen any bounds.
typedef struct Places {
    float at[3][GATHER_BEAM_WIDTH];
} Places;

/// Loads the receivers of a bundle from `first` on; those beyond its last packet are absent.
static inline void load_receivers(Receivers* to, const global ReceiverPacket* packets, const Bundle* bundle,
                                  uint first) {
    for (uint row = 0; row < GATHER_ROWS; ++row) {
        const uint lane = first + 16 * row;
        const bool there = lane / NEARLIGHT_PACKET_SIZE < bundle->count;
        const global ReceiverPacket* packet =
            packets + bundle->first + (there ? lane / NEARLIGHT_PACKET_SIZE : 0);
        const uint at = lane % NEARLIGHT_PACKET_SIZE / 16;
        const float16 absent = (float16)0.0f;
        to->x[row] = vload16(at, packet->px);
        to->y[row] = vload16(at, packet->py);
        to->z[row] = vload16(at, packet->pz);
        to->nx[row] = there ? vload16(at, packet->nx) : absent;
        to->ny[row] = there ? vload16(at, packet->ny) : absent;
        to->nz[row] = there ? vload16(at, packet->nz) : absent;
    }
}

static inline void place_receivers(Places* places, const Receivers* receivers) {
    for (uint row = 0; row < GATHER_ROWS; ++row) {
        const float16 x = receivers->x[row], y = receivers->y[row], z = receivers->z[row];
        const int16 present =
            (receivers->nx[row] != 0.0f) | (receivers->ny[row] != 0.0f) | (receivers->nz[row] != 0.0f);
        const int16 good = present & isfinite(x + y + z);
        const float16 nowhere = (float16)INFINITY;
        vstore16(good ? x : nowhere, row, places->at[0]);
        vstore16(good ? y : nowhere, row, places->at[1]);
        vstore16(good ? z : nowhere, row, places->at[2]);
    }
}

/// The box of `count` places. Where no receiver is present, it is inverted: low is +∞ and high is −∞.
static inline void bound_places(const Places* places, const uchar* order, uint count, float3* low,
                                float3* high) {
    *low = (float3)INFINITY;
    *high = (float3)-INFINITY;
    for (uint i = 0; i < count; ++i) {
        const float3 at = (float3)(places->at[0][order[i]], places->at[1][order[i]], places->at[2][order[i]]);
        *low = fmin(*low, at);
        *high = fmax(*high, at.x < INFINITY ? at : (float3)-INFINITY);
    }
}

/// Sorts `order` by ascending `key`, to the precision of ORDER_BINS equal steps from `low` to `high`.
#define ORDER_BINS 64
static inline void order_by(const float* key, float low, float high, uchar* order, uint count) {
    ushort ends[ORDER_BINS + 1];
    uchar bins[GATHER_BEAM_WIDTH], sorted[GATHER_BEAM_WIDTH];
    for (uint i = 0; i <= ORDER_BINS; ++i) {
        ends[i] = 0;
    }
    const float scale = (ORDER_BINS - 1) / fmax(high - low, 1e-30f);
    for (uint i = 0; i < count; ++i) {
        bins[i] = (uchar)fmin((key[order[i]] - low) * scale, (float)(ORDER_BINS - 1));
        ++ends[bins[i] + 1];
    }
    for (uint i = 1; i < ORDER_BINS; ++i) {
        ends[i] += ends[i - 1];
    }
    for (uint i = 0; i < count; ++i) {
        sorted[ends[bins[i]]++] = order[i];
    }
    for (uint i = 0; i < count; ++i) {
        order[i] = sorted[i];
    }
}

static inline float component(float3 v, uint axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Puts `order` into the order of the clusters: four slices along the longest side of the box, each cut in
/// four along its own longest side.
static inline void find_clusters(const Places* places, uchar* order) {
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        order[i] = (uchar)i;
    }
    for (uint size = GATHER_BEAM_WIDTH; size > CLUSTER_SIZE; size /= 4) {
        for (uint first = 0; first < GATHER_BEAM_WIDTH; first += size) {
            float3 low, high;
            bound_places(places, order + first, size, &low, &high);
            const float3 sides = high - low;
            const uint axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
            order_by(places->at[axis], component(low, axis), component(high, axis), order + first, size);
        }
    }
}

static inline void permute(float16* lanes, const uchar* order) {
    float unordered[GATHER_BEAM_WIDTH];
    for (uint row = 0; row < GATHER_ROWS; ++row) {
        vstore16(lanes[row], row, unordered);
    }
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        ((float*)lanes)[i] = unordered[order[i]];
    }
}

/// Loads the receivers of a beam in the order of their clusters, and computes their bounds.
static inline void gather_receivers(Receivers* receivers, BeamBounds* bounds,
                                    const global ReceiverPacket* packets, const Bundle* bundle, uint first) {
    Places places;
    load_receivers(receivers, packets, bundle, first);
    place_receivers(&places, receivers);
    find_clusters(&places, receivers->order);
    bounds->low = (float3)INFINITY;
    bounds->high = (float3)-INFINITY;
    for (uint cluster = 0; cluster < CLUSTERS; ++cluster) {
        float3 low, high;
        bound_places(&places, receivers->order + cluster * CLUSTER_SIZE, CLUSTER_SIZE, &low, &high);
        ((float*)&bounds->cluster_low[0])[cluster] = low.x;
        ((float*)&bounds->cluster_low[1])[cluster] = low.y;
        ((float*)&bounds->cluster_low[2])[cluster] = low.z;
        ((float*)&bounds->cluster_high[0])[cluster] = high.x;
        ((float*)&bounds->cluster_high[1])[cluster] = high.y;
        ((float*)&bounds->cluster_high[2])[cluster] = high.z;
        bounds->low = fmin(bounds->low, low);
        bounds->high = fmax(bounds->high, high);
    }
    permute(receivers->x, receivers->order);
    permute(receivers->y, receivers->order);
    permute(receivers->z, receivers->order);
    permute(receivers->nx, receivers->order);
    permute(receivers->ny, receivers->order);
    permute(receivers->nz, receivers->order);
}

/// Loads the thresholds of receivers that gather_receivers() has put in order. `thresholds` has one number
/// for each receiver of all packets.
static inline void load_thresholds(Receivers* receivers, const global float* thresholds, const Bundle* bundle,
                                   uint first) {
    float lanes[GATHER_BEAM_WIDTH];
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        const uint lane = first + receivers->order[i];
        const bool there = lane / NEARLIGHT_PACKET_SIZE < bundle->count;
        lanes[i] = there ? thresholds[(size_t)bundle->first * NEARLIGHT_PACKET_SIZE + lane] : 0.0f;
    }
    for (uint row = 0; row < GATHER_ROWS; ++row) {
        receivers->threshold[row] = vload16(row, lanes);
    }
}

/// Loads the transmission curves of receivers that gather_receivers() has put in order.
static inline void load_curves(Receivers* receivers, const global ReceiverPacket* packets,
                               const Bundle* bundle, uint first) {
    receivers->curved_rows = 0;
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        const uint lane = first + receivers->order[i];
        const bool there = lane / NEARLIGHT_PACKET_SIZE < bundle->count;
        const global ReceiverPacket* packet =
            packets + bundle->first + (there ? lane / NEARLIGHT_PACKET_SIZE : 0);
        receivers->curve[i] = there ? (ushort)receiver_curve(packet, lane % NEARLIGHT_PACKET_SIZE) : 0;
        receivers->curved_rows |= (receivers->curve[i] != 0 ? 1u : 0u) << i / 16;
    }
}

/// Loads the maps of receivers that gather_receivers() has put in order. Where there is none, the mesh's
/// normal is the receiver's own, and the map makes no shadows.
static inline void load_maps(Receivers* receivers, const global ReceiverPacket* packets, const Bundle* bundle,
                             uint first) {
    receivers->mapped_rows = 0;
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        const uint lane = first + receivers->order[i];
        const bool there = lane / NEARLIGHT_PACKET_SIZE < bundle->count;
        const float3 own = (float3)(((const float*)receivers->nx)[i], ((const float*)receivers->ny)[i],
                                    ((const float*)receivers->nz)[i]);
        float3 mesh = (float3)(0.0f);
        if (there) {
            mesh = receiver_mesh_normal(packets + bundle->first + lane / NEARLIGHT_PACKET_SIZE,
                                        lane % NEARLIGHT_PACKET_SIZE);
        }
        const bool is_mapped = dot(mesh, mesh) > 0.0f;
        mesh = is_mapped ? mesh : own;
        ((float*)receivers->mesh_x)[i] = mesh.x;
        ((float*)receivers->mesh_y)[i] = mesh.y;
        ((float*)receivers->mesh_z)[i] = mesh.z;
        ((float*)receivers->map_tilt)[i] = is_mapped ? map_tilt(dot(own, mesh)) : 0.0f;
        receivers->mapped_rows |= (is_mapped ? 1u : 0u) << i / 16;
    }
}

#endif
