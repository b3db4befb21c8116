// SPDX-License-Identifier: Apache-2.0
// Cuts through a tree of VPLs. They decide which few VPLs of a large set a bundle of receivers asks about,
// and how much each of these counts: 1/p for a VPL that is chosen with probability p, which is unbiased.
//
// The tree stands on runs of NEARLIGHT_CUT_FANOUT consecutive VPLs along the Morton curve; a level above has
// as many nodes of the level below to a node. A bundle begins with the nodes of the top level and opens
// those that could bring much, until no node is left that is worth a large part of a VPL. The VPLs it asks
// about are then drawn from this cut in proportion to what its entries could bring (lib/cut_bound.cl), and
// within a node by the same rule, from child to child. A VPL that is worth more than one draw is asked for
// certain.
//
// The draw is systematic along the curve. All bundles have one random shift, and each stratum, which with
// cuts is only a number, moves it by an equal step. So the samples of a pixel, which take turns at the
// strata, together make a systematic draw that is as many times denser. host/stages/light_cuts.h is the
// interface.

#include "lib/cut_bound.cl"

// A node is opened if it is worth more than this many VPLs of the bundle.
#define CUT_OPEN 0.25f
// The minimum probability of a VPL that could bring light, and the minimum share of a child. They only keep
// 1/p finite.
#define MIN_PROBABILITY 1e-6f
#define MIN_CHILD_SHARE 1e-3f

/// A VPL as a tree sees it. Its power is 0 if the gather leaves it out, because a number is not finite.
static inline Emission emission_of_vpl(const global Vpl* vpl) {
    const float3 power = fabs(load3(vpl->power)) * M_1_PI_F;
    Emission emission;
    emission.center = load3(vpl->position);
    emission.radius = 0.0f;
    emission.axis = load3(vpl->normal);
    emission.spread = 0.0f;
    const float sum = dot(emission.center, emission.axis) + power.x + power.y + power.z;
    emission.power = isfinite(sum) ? max_component(power) : 0.0f;
    return emission;
}

/// Adds to the box, the power and the weighted normal of a node.
static inline void add_to_node(float3 low, float3 high, float3 axis, float power, float3* node_low,
                               float3* node_high, float3* node_axis, float* node_power) {
    if (power > 0.0f) {
        *node_low = fmin(*node_low, low);
        *node_high = fmax(*node_high, high);
        *node_axis += power * axis;
        *node_power += power;
    }
}

static inline void store_node(global CutNode* node, float3 low, float3 high, float3 axis, float spread,
                              float power, uint first_child, uint child_count) {
    node->low = store3(low);
    node->high = store3(high);
    node->axis = store3(axis);
    node->spread = spread;
    node->power = power;
    node->children = first_child << 4 | child_count;
}

/// Makes the nodes of the lowest level. One work-item for each.
kernel void cut_leaves(const global Vpl* vpls, uint vpl_count, global CutNode* nodes, uint node_count) {
    const uint item = (uint)get_global_id(0);
    if (item >= node_count) {
        return;
    }
    const uint first = item * NEARLIGHT_CUT_FANOUT;
    const uint end = min(first + NEARLIGHT_CUT_FANOUT, vpl_count);
    float3 low = (float3)INFINITY, high = (float3)-INFINITY, axis = (float3)0.0f;
    float power = 0.0f;
    for (uint i = first; i < end; ++i) {
        const Emission vpl = emission_of_vpl(vpls + i);
        add_to_node(vpl.center, vpl.center, vpl.axis, vpl.power, &low, &high, &axis, &power);
    }
    axis = power > 0.0f ? axis / power : axis;
    float spread = 0.0f;
    for (uint i = first; i < end; ++i) {
        const Emission vpl = emission_of_vpl(vpls + i);
        spread = vpl.power > 0.0f ? fmax(spread, length(vpl.axis - axis)) : spread;
    }
    store_node(nodes + item, low, high, axis, spread, power, first, end - first);
}

/// Makes nodes [first_node, first_node + node_count) from those of the level below, which are
/// [first_child, first_child + child_count). One work-item for each.
kernel void cut_level(global CutNode* nodes, uint first_child, uint child_count, uint first_node,
                      uint node_count) {
    const uint item = (uint)get_global_id(0);
    if (item >= node_count) {
        return;
    }
    const uint first = first_child + item * NEARLIGHT_CUT_FANOUT;
    const uint end = min(first + NEARLIGHT_CUT_FANOUT, first_child + child_count);
    float3 low = (float3)INFINITY, high = (float3)-INFINITY, axis = (float3)0.0f;
    float power = 0.0f;
    for (uint i = first; i < end; ++i) {
        add_to_node(load3(nodes[i].low), load3(nodes[i].high), load3(nodes[i].axis), nodes[i].power, &low,
                    &high, &axis, &power);
    }
    axis = power > 0.0f ? axis / power : axis;
    float spread = 0.0f;
    for (uint i = first; i < end; ++i) {
        const float reach = length(load3(nodes[i].axis) - axis) + nodes[i].spread;
        spread = nodes[i].power > 0.0f ? fmax(spread, reach) : spread;
    }
    store_node(nodes + first_node + item, low, high, axis, spread, power, first, end - first);
}

/// What a bundle's cut is made from.
typedef struct CutSource {
    const global Vpl* vpls;
    const global CutNode* nodes;
    BundleClusters clusters;
    uint leaf_count;
    float clamp_radius_squared;
} CutSource;

/// The entry for a node or a VPL.
static inline CutEntry cut_entry(const CutSource* source, uint place, const Emission* emission) {
    CutEntry entry;
    entry.place = place;
    entry.bound =
        emission->power > 0.0f ? cut_bound(&source->clusters, emission, source->clamp_radius_squared) : 0.0f;
    return entry;
}

/// The entry for child `k` of the node at `place`.
static inline CutEntry child_entry(const CutSource* source, uint place, uint k) {
    const uint child = (source->nodes[place].children >> 4) + k;
    const bool is_vpl = place < source->leaf_count;
    const Emission emission =
        is_vpl ? emission_of_vpl(source->vpls + child) : emission_of_node(source->nodes + child);
    return cut_entry(source, is_vpl ? child | NEARLIGHT_CUT_VPL : child, &emission);
}

static inline uint child_count(const CutSource* source, uint place) {
    return source->nodes[place].children & 15u;
}

static inline bool is_vpl_entry(CutEntry entry) {
    return (entry.place & NEARLIGHT_CUT_VPL) != 0;
}

static inline float total_bound(const global CutEntry* cut, uint count) {
    float total = 0.0f;
    for (uint i = 0; i < count; ++i) {
        total += cut[i].bound;
    }
    return total;
}

/// Copies a cut of `count` entries, with the children of nodes above `limit` in place of these as long as
/// there is room. Returns the number of entries; `opened` gets whether there was any such node.
static inline uint open_nodes(const CutSource* source, const global CutEntry* from, uint count, float limit,
                              global CutEntry* to, uint capacity, bool* opened) {
    uint size = 0;
    *opened = false;
    for (uint i = 0; i < count; ++i) {
        const CutEntry entry = from[i];
        const bool fits = size + NEARLIGHT_CUT_FANOUT + (count - i - 1) <= capacity;
        if (is_vpl_entry(entry) || !(entry.bound > limit) || !fits) {
            to[size++] = entry;
            continue;
        }
        *opened = true;
        for (uint k = 0; k < child_count(source, entry.place); ++k) {
            const CutEntry child = child_entry(source, entry.place, k);
            if (child.bound > 0.0f) {
                to[size++] = child;
            }
        }
    }
    return size;
}

/// The bound that is worth one draw: VPLs above it are asked for certain, and all other entries share the
/// rest of the `asked` draws. Each round finds more VPLs that are certain. Any limit is unbiased, so a few
/// rounds are enough.
static inline float bound_of_draw(const global CutEntry* cut, uint count, float asked) {
    float limit = INFINITY;
    for (uint round = 0; round < 16; ++round) {
        float rest = 0.0f;
        uint certain = 0;
        for (uint i = 0; i < count; ++i) {
            const bool is_certain = is_vpl_entry(cut[i]) && cut[i].bound >= limit;
            certain += is_certain ? 1 : 0;
            rest += is_certain ? 0.0f : cut[i].bound;
        }
        const float next = rest / fmax(asked - (float)certain, 1e-3f);
        if (!(next < limit)) {
            break;
        }
        limit = next;
    }
    return limit;
}

/// Draws a VPL below a node, where `at` in [0, 1) says which. Returns its index, or ~0u if none could bring
/// anything; `p` is multiplied by its probability.
static inline uint draw_below(const CutSource* source, uint place, float at, float* p) {
    while (true) {
        CutEntry children[NEARLIGHT_CUT_FANOUT];
        const uint count = child_count(source, place);
        float total = 0.0f;
        for (uint k = 0; k < count; ++k) {
            children[k] = child_entry(source, place, k);
            total += children[k].bound;
        }
        if (!(total > 0.0f)) {
            return ~0u;
        }
        float sum = 0.0f;
        for (uint k = 0; k < count; ++k) {
            children[k].bound =
                children[k].bound > 0.0f ? fmax(children[k].bound, MIN_CHILD_SHARE * total) : 0.0f;
            sum += children[k].bound;
        }
        at *= sum;
        uint chosen = count;
        for (uint k = 0; k < count; ++k) {
            const float bound = children[k].bound;
            if (bound > 0.0f) {
                if (chosen < count) {
                    at -= children[chosen].bound;
                }
                chosen = k;
                if (at < bound) {
                    break;
                }
            }
        }
        const CutEntry child = children[chosen];
        at = clamp(at / child.bound, 0.0f, 0x1.fffffep-1f);
        *p *= child.bound / sum;
        if (is_vpl_entry(child)) {
            return child.place & ~NEARLIGHT_CUT_VPL;
        }
        place = child.place;
    }
}

/// The VPLs that a bundle asks about, in their order.
typedef struct CutList {
    global uint* vpls;
    global float* weights;
    uint count, capacity;
} CutList;

static inline void ask(CutList* list, uint vpl, float weight) {
    if (list->count < list->capacity) {
        list->vpls[list->count] = vpl;
        list->weights[list->count] = weight;
        ++list->count;
    }
}

/// Draws VPLs from a cut. `next` in [0, 1) is where the first draw lies in the running sum of expected draws.
static inline void draw(const CutSource* source, const global CutEntry* cut, uint count, float asked,
                        float next, CutList* list) {
    const float limit = bound_of_draw(cut, count, asked);
    for (uint i = 0; i < count; ++i) {
        const CutEntry entry = cut[i];
        const uint vpl = entry.place & ~NEARLIGHT_CUT_VPL;
        if (is_vpl_entry(entry) && entry.bound >= limit) {
            ask(list, vpl, 1.0f);
            continue;
        }
        // Where denormals count as 0 and all bounds are tiny, the quotient is not finite.
        const float expected = fmin(fmax(entry.bound / limit, MIN_PROBABILITY), asked);
        for (; next < expected; next += 1.0f) {
            if (is_vpl_entry(entry)) {
                ask(list, vpl, 1.0f / expected);
            } else {
                float p = expected;
                const uint drawn = draw_below(source, entry.place, next / expected, &p);
                if (drawn != ~0u) {
                    ask(list, drawn, 1.0f / p);
                }
            }
        }
        next -= expected;
    }
}

/// Lists the VPLs that each bundle asks about, in their order, in `chosen`, with their factors in `weights`.
/// The list of a bundle begins at entry (bundle − first_bundle)·list_stride, and counts[bundle −
/// first_bundle] is its length. `entries` has room for 2·capacity entries for each bundle. One work-item for
/// each bundle.
kernel void cut_choose(const global Vpl* vpls, const global CutNode* nodes,
                       const global ReceiverPacket* receivers, const global uint* stratum_of_bundle,
                       const global CutParams* launch_params, global CutEntry* entries, global uint* chosen,
                       global float* weights, global uint* counts) {
    const CutParams params = *launch_params;
    const uint listed = (uint)get_global_id(0);
    const uint index = params.first_bundle + listed;
    if (index >= params.end_bundle) {
        return;
    }
    const Bundle bundle = bundle_at(index, params.packet_count);
    CutSource source;
    source.vpls = vpls;
    source.nodes = nodes;
    source.clusters = clusters_of(receivers, &bundle);
    source.leaf_count = params.leaf_count;
    source.clamp_radius_squared = params.clamp_radius_squared;
    global CutEntry* cut = entries + (size_t)listed * 2 * params.capacity;
    global CutEntry* other = cut + params.capacity;
    uint count = 0;
    for (uint i = params.first_root; i < params.first_root + params.root_count; ++i) {
        const Emission emission = emission_of_node(nodes + i);
        const CutEntry root = cut_entry(&source, i, &emission);
        if (root.bound > 0.0f) {
            cut[count++] = root;
        }
    }
    bool opened = true;
    while (opened) {
        const float limit = CUT_OPEN * total_bound(cut, count) / params.asked;
        count = open_nodes(&source, cut, count, limit, other, params.capacity, &opened);
        global CutEntry* const refined = other;
        other = cut;
        cut = refined;
    }
    const uint stratum = params.strata > 1 ? stratum_of_bundle[index % params.stratum_period] : 0;
    const float moved = params.shift + (float)stratum / (float)params.strata;
    CutList list;
    list.vpls = chosen + (size_t)listed * params.list_stride;
    list.weights = weights + (size_t)listed * params.list_stride;
    list.count = 0;
    list.capacity = params.list_stride;
    draw(&source, cut, count, params.asked, moved - floor(moved), &list);
    counts[listed] = list.count;
}
