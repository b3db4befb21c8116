// SPDX-License-Identifier: Apache-2.0
// Sums a set of VPLs over receivers, for CPUs:
// irradiance E(x) = Σ power/π · T(cosθx)·T(cosθy) · F · max0(cosθx)·max0(cosθy)/max(r², R²) · V, where T are
// the transmission curves of both surfaces (lib/curve.cl), and F is what the receiver's map leaves of the
// light (lib/map_shadowing.cl); they are 1 for most.
//
// A work-item takes beams of GATHER_BEAM_WIDTH receivers, each with a run of VPLs. The compiler does not turn
// a divergent traversal loop into vector code, so the vectors are written out: a beam is rows of 16 lanes
// that go through the wide tree together. What makes this fast:
// - All rays of a beam start at the VPL, so box − origin is the same for all lanes, and the triangle test is
//   four dot products for each lane, with constants of the (VPL, triangle) pair and without a division.
// - Receivers are put in order once, so that 16 runs of them are clusters with small boxes
//   (lib/beam_receivers.cl).
// - The eight children of a node are tested at once against the shaft from the VPL to the box of all
//   receivers. Each child that meets it is tested at once against the shafts to the boxes of the 16 clusters
//   (lib/shaft.cl). Lanes are tested only with boxes that their cluster meets.
// - Nodes and leaves are taken several at a time, almost without branches that depend on tests
//   (lib/wide_traverse.cl).
// - A leaf is tested with the lanes that meet its box. Where these are few, each is tested with four
//   triangles in one vector (lib/beam_blocks.cl).
// - A bit mask for each row says which lanes are neither culled nor occluded. A leaf asks it again when its
//   turn comes, because by then some lanes have met their occluder.
// A segment is occluded if it hits a triangle of a leaf whose box it meets. Neither test looks at other
// lanes, and all tests before them are conservative, so that the other receivers of a beam do not change a
// bit of the result.
//
// gather_rays.cl computes the same on GPUs. host/stages/gatherer.h is the interface of both.

#include "lib/gather.cl"
#include "lib/wide_traverse.cl"

#define BEAMS_PER_BUNDLE (BUNDLE_RECEIVERS / GATHER_BEAM_WIDTH)

typedef struct Accumulator {
    float16 r[GATHER_ROWS], g[GATHER_ROWS], b[GATHER_ROWS];
} Accumulator;

static inline void add_visible(Accumulator* sum, const Segments* s, float3 scale, bool squared) {
    for (uint open = s->open; open != 0; open &= ~clusters_of_row(first_row(open))) {
        const uint row = first_row(open);
        const float16 term = lanes_of(s->lanes[row]) ? s->weight[row] : (float16)0.0f;
        const float16 weight = squared ? term * term : term;
        sum->r[row] += scale.x * weight;
        sum->g[row] += scale.y * weight;
        sum->b[row] += scale.z * weight;
    }
}

static inline void clear(Accumulator* sum) {
    for (uint row = 0; row < GATHER_ROWS; ++row) {
        sum->r[row] = sum->g[row] = sum->b[row] = (float16)0.0f;
    }
}

/// Adds `sum` to the irradiance, or stores it there if `replace` is set. Lane i has receiver first + order[i]
/// of the bundle.
static inline void add_to_irradiance(global IrradiancePacket* irradiance, const Bundle* bundle, uint first,
                                     const uchar* order, const Accumulator* sum, bool replace) {
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        const uint packet = (first + order[i]) / NEARLIGHT_PACKET_SIZE;
        const uint lane = (first + order[i]) % NEARLIGHT_PACKET_SIZE;
        if (packet < bundle->count) {
            global IrradiancePacket* to = irradiance + bundle->first + packet;
            to->r[lane] = ((const float*)sum->r)[i] + (replace ? 0.0f : to->r[lane]);
            to->g[lane] = ((const float*)sum->g)[i] + (replace ? 0.0f : to->g[lane]);
            to->b[lane] = ((const float*)sum->b)[i] + (replace ? 0.0f : to->b[lane]);
        }
    }
}

#ifdef GATHER_RECORD
/// Records which segments are open if `before` is set, and after tracing which of them no longer are.
static inline void record_open(global uchar* record, uint vpl, uint vpl_count, const Bundle* bundle,
                               uint first, const uchar* order, const Segments* s, bool before) {
    for (uint i = 0; i < GATHER_BEAM_WIDTH; ++i) {
        const uint packet = (first + order[i]) / NEARLIGHT_PACKET_SIZE;
        const uint lane = (first + order[i]) % NEARLIGHT_PACKET_SIZE;
        const bool open = (s->lanes[i / 16] >> i % 16 & 1) != 0;
        if (packet < bundle->count) {
            global uchar* pair = record + gather_record_index(bundle->first + packet, vpl, vpl_count, lane);
            if (before) {
                *pair = open ? NEARLIGHT_PAIR_VISIBLE : NEARLIGHT_PAIR_CULLED;
            } else if (*pair == NEARLIGHT_PAIR_VISIBLE && !open) {
                *pair = NEARLIGHT_PAIR_OCCLUDED;
            }
        }
    }
}
#define RECORD_OPEN(vpl, params, bundle, first, order, segments, before) \
    record_open(record, vpl, (params)->vpl_count, bundle, first, order, segments, before)
#else
#define RECORD_OPEN(vpl, params, bundle, first, order, segments, before)
#endif

/// Loads the receivers of a bundle from `first` on, with what else the launch asks of them.
static inline void load_beam(Receivers* receivers, BeamBounds* bounds, const global ReceiverPacket* packets,
                             const Bundle* bundle, uint first, const GatherParams* params,
                             const global float* thresholds) {
    gather_receivers(receivers, bounds, packets, bundle, first);
    if (params->has_thresholds) {
        load_thresholds(receivers, thresholds, bundle, first);
    }
    if (params->has_curves) {
        load_curves(receivers, packets, bundle, first);
    }
    if (params->has_maps) {
        load_maps(receivers, packets, bundle, first);
    }
}

/// Gathers the beams of the bundles [first_bundle, end_bundle) from the VPLs [first_vpl, end_vpl). Work-items
/// take one beam after another from a queue until none is left; `next_beam` is the number of the next one and
/// must be 0 at the start. The costs of beams differ by a factor of ten, and runtimes deal work-items to
/// threads by the dozen; launch as many work-items as there are beams, so that each thread has one.
///
/// Each chunk of VPLs (GATHER_CHUNK, or a group), counted from VPL 0, is summed by itself and then added to
/// `sums`, so that the result does not depend on how launches divide the work; first_vpl must begin a chunk.
/// Launches over the VPLs of one bundle must follow one another in order, from VPL 0 on.
///
/// Without groups, `sums` gets the light of all VPLs, and `group_sums` is not touched. With groups, `sums`
/// gets the squares of all pairs' light, and `group_sums` gets packet_count packets of light for each group.
///
/// With thresholds, a pair is left out if its light, squared, would be less than the receiver's number in
/// `thresholds` (64 · packet + lane) with nothing in the way.
///
/// With strata, a bundle asks only about its own, and `strata` says which that is (stratum_of() in
/// lib/bundle.cl); VPLs are then counted within the stratum. Groups are for a single stratum.
kernel __attribute__((reqd_work_group_size(1, 1, 1))) void gather_packets(
    const global WideNode* nodes, const global TriangleBlock* blocks, const global Vpl* vpls,
    const global ReceiverPacket* packets, const global GatherParams* launch_params,
    const global float* thresholds, const global float* curves, const global uint* strata,
    global IrradiancePacket* sums, global IrradiancePacket* group_sums,
    volatile global uint* next_beam GATHER_LIST_PARAMETERS GATHER_RECORD_PARAMETERS) {
    Receivers receivers;
    BeamBounds bounds;
    Segments segments;
    Accumulator sum, squares;
    const GatherParams params = *launch_params;
    const uint chunk_size = gather_chunk_size(params.group_size);
    const uint count = (params.end_bundle - params.first_bundle) * BEAMS_PER_BUNDLE;
    for (uint item = atomic_inc(next_beam); item < count; item = atomic_inc(next_beam)) {
        const uint index = params.first_bundle + item / BEAMS_PER_BUNDLE;
        const Bundle bundle = bundle_at(index, params.packet_count);
        const uint first = item % BEAMS_PER_BUNDLE * GATHER_BEAM_WIDTH;
        if (first / NEARLIGHT_PACKET_SIZE >= bundle.count) {
            continue;
        }
        load_beam(&receivers, &bounds, packets, &bundle, first, &params, thresholds);
        const Stratum stratum = gather_stratum(index, &params, strata);
        const uint end = min(params.end_vpl, GATHER_COUNT(index, &params, &stratum));
        for (uint chunk = params.first_vpl; chunk < end || chunk == 0; chunk += chunk_size) {
            clear(&sum);
            clear(&squares);
            for (uint k = chunk; k < min(chunk + chunk_size, end); ++k) {
                const uint i = GATHER_VPL(index, &params, &stratum, k);
                const float3 scale = gather_scale(vpls + i) * GATHER_WEIGHT(index, &params, &stratum, k);
                connect(&segments, vpls + i, &receivers, params.clamp_radius_squared);
                if (is_tilted(vpls + i)) {
                    leave_out_unseen(&segments, seen_normal(vpls + i));
                }
                if (params.has_thresholds) {
                    leave_out_small(&segments, &receivers, gather_square_scale(vpls + i, scale));
                }
                RECORD_OPEN(i, &params, &bundle, first, receivers.order, &segments, true);
                trace_segments(&segments, &bounds, nodes, blocks);
                RECORD_OPEN(i, &params, &bundle, first, receivers.order, &segments, false);
                if (params.has_curves) {
                    weigh_by_curves(&segments, vpls + i, &receivers, curves);
                }
                if (params.has_maps) {
                    weigh_by_maps(&segments, &receivers);
                }
                add_visible(&sum, &segments, scale, gather_squared(vpls + i));
                if (params.group_size != 0) {
                    add_visible(&squares, &segments, scale * scale, true);
                }
            }
            if (params.group_size != 0) {
                add_to_irradiance(sums, &bundle, first, receivers.order, &squares, chunk == 0);
                add_to_irradiance(group_sums + (size_t)(chunk / params.group_size) * params.packet_count,
                                  &bundle, first, receivers.order, &sum, true);
            } else {
                add_to_irradiance(sums, &bundle, first, receivers.order, &sum, chunk == 0);
            }
        }
    }
}
