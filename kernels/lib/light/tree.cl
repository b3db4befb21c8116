// SPDX-License-Identifier: Apache-2.0
// Chooses a light for a receiver by walking down a tree of light bounds, from each node to a child that could
// bring much [Conty Estévez & Kulla, Importance Sampling of Many Lights with Adaptive Tree
// Splitting, 2018]. host/scene/light_tree.cpp builds it.
#ifndef NEARLIGHT_LIB_LIGHT_TREE
#define NEARLIGHT_LIB_LIGHT_TREE

#include "lib/light/receiver.cl"

/// The cosine and the sine of an angle between 0 and π.
typedef struct Angle {
    float cosine, sine;
} Angle;
static inline Angle angle_of_cosine(float cosine) {
    Angle angle;
    angle.cosine = clamp(cosine, -1.0f, 1.0f);
    angle.sine = sqrt(fmax(0.0f, 1.0f - angle.cosine * angle.cosine));
    return angle;
}
/// a − b, or 0 if b is greater.
static inline Angle angle_beyond(Angle a, Angle b) {
    Angle rest;
    rest.cosine = a.cosine > b.cosine ? 1.0f : a.cosine * b.cosine + a.sine * b.sine;
    rest.sine = a.cosine > b.cosine ? 0.0f : a.sine * b.cosine - a.cosine * b.sine;
    return rest;
}

/// About the most that a lobe of GGX facets [Walter et al. 2007] reflects to the viewer of light within
/// `spread` of a direction, in units of what an even surface reflects of light along its normal. The half
/// vector of a direction turns by half as much as the direction, or by more where light grazes, and a lobe
/// narrower than the spread gets only a part of the light.
static inline float lobe_response(const LightReceiver* at, float3 direction, Angle spread) {
    const float3 sum = at->viewer + direction;
    const float extent = fmax(length(sum), 1e-3f);
    Angle turn;
    turn.sine = fmin(spread.sine / extent, 1.0f);
    turn.cosine = sqrt(1.0f - turn.sine * turn.sine);
    const Angle tilt = angle_beyond(angle_of_cosine(dot(at->n, sum) / extent), turn);
    const float alpha2 = at->alpha * at->alpha;
    const float slope = tilt.cosine * tilt.cosine * (alpha2 - 1.0f) + 1.0f;
    const float response = alpha2 / (slope * slope * 4.0f * fmax(dot(at->n, at->viewer), 0.1f));
    return fmin(response, 0.5f / fmax(1.0f - spread.cosine, 1e-9f));
}

/// About how much of the light below a node the receiver sends on: its irradiance, or, as far as the receiver
/// is glossy, what its lobe reflects. It is 0 only where the lights bring nothing: if all of them face away
/// from the receiver, or lie below its horizon.
static inline float light_node_importance(const global LightNode* node, const LightReceiver* at) {
    const float3 x = at->x;
    const float3 n = at->n;
    const float3 low = load3(node->low);
    const float3 high = load3(node->high);
    const float3 to_center = 0.5f * (low + high) - x;
    const float3 half_size = 0.5f * (high - low);
    const float squared = dot(to_center, to_center);
    const float radius_squared = dot(half_size, half_size) * 1.0001f;
    const float nearest_squared = fmax(squared, radius_squared);
    if (squared <= radius_squared) {
        return node->power / fmax(nearest_squared, 1e-30f);
    }
    const float3 direction = to_center * rsqrt(squared);
    // The angle that the sphere around the box covers, as seen from x.
    Angle spread;
    spread.sine = sqrt(radius_squared / squared);
    spread.cosine = sqrt(fmax(0.0f, 1.0f - radius_squared / squared));
    Angle cone;
    cone.cosine = node->cos_spread;
    cone.sine = sqrt(fmax(0.0f, 1.0f - cone.cosine * cone.cosine));
    const Angle emission =
        angle_beyond(angle_beyond(angle_of_cosine(-dot(load3(node->axis), direction)), cone), spread);
    const Angle incidence =
        dot(n, n) > 0.0f ? angle_beyond(angle_of_cosine(dot(n, direction)), spread) : angle_of_cosine(1.0f);
    // Rounding must not take away a light at a grazing angle.
    const float margin = 1e-3f;
    if (emission.cosine <= node->cos_beam - margin || incidence.cosine <= -margin) {
        return 0.0f;
    }
    float response = fmax(incidence.cosine, margin);
    if (at->gloss > 0.0f) {
        response = mix(response, lobe_response(at, direction, spread), at->gloss);
    }
    return node->power * fmax(emission.cosine, margin) * response / nearest_squared;
}

/// How much of the choice of a child is even, relative to the part that follows importance: the most
/// important lamp may be hidden, and a lamp that is seldom chosen would bring much light at once.
#define EVEN_CHOICE 0.1f

/// The children of a node, and how much each could bring.
typedef struct LightChildren {
    float importance[NEARLIGHT_LIGHT_TREE_WIDTH];
    float sum;
    uint first, count;
} LightChildren;
static inline LightChildren weigh_children(const SceneView* scene, uint node, const LightReceiver* at) {
    LightChildren children;
    children.first = scene->light_nodes[node].first_child;
    children.count = scene->light_nodes[node].child_count;
    children.sum = 0.0f;
    uint bring_light = 0;
    for (uint i = 0; i < children.count; ++i) {
        children.importance[i] = light_node_importance(scene->light_nodes + children.first + i, at);
        children.sum += children.importance[i];
        bring_light += children.importance[i] > 0.0f ? 1u : 0u;
    }
    const float even = EVEN_CHOICE * children.sum / (float)max(bring_light, 1u);
    for (uint i = 0; i < children.count; ++i) {
        children.importance[i] += children.importance[i] > 0.0f ? even : 0.0f;
    }
    children.sum *= 1.0f + EVEN_CHOICE;
    return children;
}

/// The index of the chosen light in the table of lights, or ~0u if none brings anything. `probability`
/// gets that of the choice.
static inline uint choose_in_light_tree(const SceneView* scene, const LightReceiver* at, float u,
                                        float* probability) {
    uint node = 0;
    *probability = 1.0f;
    while (scene->light_nodes[node].child_count != 0) {
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
        for (uint i = 0; i < children.count; ++i) {
            if (children.importance[i] > 0.0f && begin <= place) {
                chosen = i;
                chosen_begin = begin;
            }
            begin += children.importance[i];
        }
        u = clamp((place - chosen_begin) / children.importance[chosen], 0.0f, 0x1.fffffep-1f);
        *probability *= children.importance[chosen] / children.sum;
        node = children.first + chosen;
    }
    return scene->light_nodes[node].emitter;
}

/// The probability with which choose_in_light_tree() picks the light at `index` of the table.
static inline float light_tree_probability(const SceneView* scene, uint index, const LightReceiver* at) {
    uint way = scene->emitters[index].tree_way;
    uint node = 0;
    float probability = 1.0f;
    while (scene->light_nodes[node].child_count != 0) {
        const LightChildren children = weigh_children(scene, node, at);
        const uint next = way % NEARLIGHT_LIGHT_TREE_WIDTH;
        if (!(children.importance[next] > 0.0f)) {
            return 0.0f;
        }
        probability *= children.importance[next] / children.sum;
        node = children.first + next;
        way /= NEARLIGHT_LIGHT_TREE_WIDTH;
    }
    return probability;
}

#endif
