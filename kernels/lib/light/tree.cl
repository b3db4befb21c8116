// SPDX-License-Identifier: Apache-2.0
// Chooses a light for a receiver by walking down a tree of light bounds, from each node to a child that could
// bring much [Conty Estévez & Kulla, Importance Sampling of Many Lights with Adaptive Tree
// Splitting, 2018]. host/scene/light_tree.cpp builds it.
#ifndef NEARLIGHT_LIB_LIGHT_TREE
#define NEARLIGHT_LIB_LIGHT_TREE

#include "lib/lanes.cl"
#include "lib/light/receiver.cl"

/// The cosines and the sines of eight angles between 0 and π, one for each child of a node.
typedef struct Angles {
    float8 cosine, sine;
} Angles;
static inline Angles angles_of_cosines(float8 cosines) {
    Angles angles;
    angles.cosine = min8(max8(cosines, (float8)(-1.0f)), (float8)(1.0f));
    angles.sine = sqrt(max8((float8)(0.0f), 1.0f - angles.cosine * angles.cosine));
    return angles;
}
/// a − b, or 0 where b is greater.
static inline Angles angles_beyond(Angles a, Angles b) {
    const int8 b_is_greater = a.cosine > b.cosine;
    Angles rest;
    rest.cosine = b_is_greater ? (float8)(1.0f) : a.cosine * b.cosine + a.sine * b.sine;
    rest.sine = b_is_greater ? (float8)(0.0f) : a.sine * b.cosine - a.cosine * b.sine;
    return rest;
}

/// Eight vectors.
typedef struct Vectors {
    float8 x, y, z;
} Vectors;
static inline float8 dots_with(Vectors a, float3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline float8 dots(Vectors a, Vectors b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// About the most that a lobe of GGX facets [Walter et al. 2007] reflects to the viewer of light within
/// `spread` of each direction, in units of what an even surface reflects of light along its normal. The half
/// vector of a direction turns by half as much as the direction, or by more where light grazes, and a lobe
/// narrower than the spread gets only a part of the light.
static inline float8 lobe_responses(const LightReceiver* at, Vectors direction, Angles spread) {
    const float3 n = at->n;
    const float3 viewer = at->viewer;
    const Vectors sum = {direction.x + viewer.x, direction.y + viewer.y, direction.z + viewer.z};
    const float8 extent = max8(sqrt(dots(sum, sum)), (float8)(1e-3f));
    Angles turn;
    turn.sine = min8(spread.sine / extent, (float8)(1.0f));
    turn.cosine = sqrt(1.0f - turn.sine * turn.sine);
    const Angles tilt = angles_beyond(angles_of_cosines(dots_with(sum, n) / extent), turn);
    const float alpha2 = at->alpha * at->alpha;
    const float8 slope = tilt.cosine * tilt.cosine * (alpha2 - 1.0f) + 1.0f;
    const float8 response = alpha2 / (slope * slope * (4.0f * fmax(dot(n, viewer), 0.1f)));
    return min8(response, 0.5f / max8(1.0f - spread.cosine, (float8)(1e-9f)));
}

/// About how much of the light below each child the receiver sends on: its irradiance, or, as far as the
/// receiver is glossy, what its lobe reflects. It is 0 only where the lights bring nothing: if all of them
/// face away from the receiver, or lie below its horizon.
static inline float8 child_importances(const global LightNode* node, const LightReceiver* at) {
    const float3 x = at->x;
    const float3 n = at->n;
    const Vectors to_center = {vload8(0, node->center[0]) - x.x, vload8(0, node->center[1]) - x.y,
                               vload8(0, node->center[2]) - x.z};
    const float8 power = vload8(0, node->power);
    const float8 radius_squared = vload8(0, node->radius_squared);
    const float8 squared = dots(to_center, to_center);
    const float8 nearest_squared = max8(max8(squared, radius_squared), (float8)(1e-30f));
    const float8 inverse = rsqrt(max8(squared, (float8)(1e-30f)));
    const Vectors direction = {to_center.x * inverse, to_center.y * inverse, to_center.z * inverse};
    // The angle that the sphere around the lights covers, as seen from x.
    Angles spread;
    const float8 covered = min8(radius_squared * inverse * inverse, (float8)(1.0f));
    spread.sine = sqrt(covered);
    spread.cosine = sqrt(1.0f - covered);
    const Vectors axis = {vload8(0, node->axis[0]), vload8(0, node->axis[1]), vload8(0, node->axis[2])};
    const Angles cone = angles_of_cosines(vload8(0, node->cos_spread));
    const Angles emission =
        angles_beyond(angles_beyond(angles_of_cosines(-dots(axis, direction)), cone), spread);
    const Angles incidence = dot(n, n) > 0.0f
                                 ? angles_beyond(angles_of_cosines(dots_with(direction, n)), spread)
                                 : angles_of_cosines((float8)(1.0f));
    // Rounding must not take away a light at a grazing angle.
    const float margin = 1e-3f;
    const int8 faces_away = emission.cosine <= vload8(0, node->cos_beam) - margin;
    const int8 lies_below = incidence.cosine <= -margin;
    float8 response = max8(incidence.cosine, (float8)(margin));
    if (at->gloss > 0.0f) {
        response = mix(response, lobe_responses(at, direction, spread), at->gloss);
    }
    const float8 outside =
        faces_away || lies_below ? (float8)(0.0f) : max8(emission.cosine, (float8)(margin)) * response;
    return power * (squared <= radius_squared ? (float8)(1.0f) : outside) / nearest_squared;
}

/// How much of the choice of a child is even, relative to the part that follows importance: the most
/// important lamp may be hidden, and a lamp that is seldom chosen would bring much light at once.
#define EVEN_CHOICE 0.1f

/// How much each child of a node could bring.
typedef struct LightChildren {
    float importance[NEARLIGHT_LIGHT_TREE_WIDTH];
    float sum;
} LightChildren;
static inline LightChildren weigh_children(const SceneView* scene, uint node, const LightReceiver* at) {
    const float8 importance = child_importances(scene->light_nodes + node, at);
    const int8 brings_light = importance > 0.0f;
    const float4 half_sum = importance.lo + importance.hi;
    const float sum = half_sum.x + half_sum.y + half_sum.z + half_sum.w;
    const float even = EVEN_CHOICE * sum / (float)max(popcount(lane_bits8(brings_light)), 1u);
    LightChildren children;
    children.sum = (1.0f + EVEN_CHOICE) * sum;
    vstore8(brings_light ? importance + even : (float8)(0.0f), 0, children.importance);
    return children;
}

/// The index of the chosen light in the table of lights, or ~0u if none brings anything. `probability`
/// gets that of the choice.
static inline uint choose_in_light_tree(const SceneView* scene, const LightReceiver* at, float u,
                                        float* probability) {
    uint node = 0;
    *probability = 1.0f;
    while (!(node & NEARLIGHT_LEAF_BIT)) {
        const LightChildren children = weigh_children(scene, node, at);
        if (!(children.sum > 0.0f)) {
            return ~0u;
        }
        // The last child that brings something and begins at or before the place, so that rounding cannot
        // choose one that brings nothing.
        const float place = u * children.sum;
        float begin = 0.0f;
        float chosen_begin = 0.0f;
        uint chosen = 0;
        for (uint i = 0; i < NEARLIGHT_LIGHT_TREE_WIDTH; ++i) {
            if (children.importance[i] > 0.0f && begin <= place) {
                chosen = i;
                chosen_begin = begin;
            }
            begin += children.importance[i];
        }
        u = clamp((place - chosen_begin) / children.importance[chosen], 0.0f, 0x1.fffffep-1f);
        *probability *= children.importance[chosen] / children.sum;
        node = scene->light_nodes[node].child[chosen];
    }
    return node & ~NEARLIGHT_LEAF_BIT;
}

/// The probability with which choose_in_light_tree() picks the light at `index` of the table.
static inline float light_tree_probability(const SceneView* scene, uint index, const LightReceiver* at) {
    uint way = scene->emitters[index].tree_way;
    uint node = 0;
    float probability = 1.0f;
    while (!(node & NEARLIGHT_LEAF_BIT)) {
        const LightChildren children = weigh_children(scene, node, at);
        const uint next = way % NEARLIGHT_LIGHT_TREE_WIDTH;
        if (!(children.importance[next] > 0.0f)) {
            return 0.0f;
        }
        probability *= children.importance[next] / children.sum;
        node = scene->light_nodes[node].child[next];
        way /= NEARLIGHT_LIGHT_TREE_WIDTH;
    }
    return probability;
}

#endif
