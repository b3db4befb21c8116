// SPDX-License-Identifier: Apache-2.0
// Chooses an area light for a receiver by walking down a tree of light bounds, at each node to the
// child that could bring more [Conty Estévez & Kulla, Importance Sampling of Many Lights with Adaptive Tree
// Splitting, 2018]. host/scene/light_tree.cpp builds it.
#ifndef NEARLIGHT_LIB_LIGHT_TREE
#define NEARLIGHT_LIB_LIGHT_TREE

#include "lib/scene.cl"

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

/// About how much irradiance the lights below a node bring to x, whose surface has the normal n (zero: light
/// counts from all sides). It is 0 only where they bring nothing: if all of them face away from x, or lie
/// below its horizon.
static inline float light_node_importance(const global LightNode* node, float3 x, float3 n) {
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
    if (emission.cosine <= -margin || incidence.cosine <= -margin) {
        return 0.0f;
    }
    return node->power * fmax(emission.cosine, margin) * fmax(incidence.cosine, margin) / nearest_squared;
}

/// The probability with which a walk that has reached the inner node goes to its first child. Negative if
/// neither child brings anything.
static inline float first_child_probability(const SceneView* scene, uint node, float3 x, float3 n) {
    const float first = light_node_importance(scene->light_nodes + node + 1, x, n);
    const float second =
        light_node_importance(scene->light_nodes + scene->light_nodes[node].second_child, x, n);
    return first + second > 0.0f ? first / (first + second) : -1.0f;
}

/// The index of the chosen light in the table of lights, or ~0u if none brings anything. `probability`
/// gets that of the choice.
static inline uint choose_in_light_tree(const SceneView* scene, float3 x, float3 n, float u,
                                        float* probability) {
    uint node = 0;
    *probability = 1.0f;
    while (scene->light_nodes[node].second_child != 0) {
        const float first = first_child_probability(scene, node, x, n);
        if (first < 0.0f) {
            return ~0u;
        }
        const bool goes_first = u < first;
        const float share = goes_first ? first : 1.0f - first;
        u = clamp((goes_first ? u : u - first) / share, 0.0f, 0x1.fffffep-1f);
        *probability *= share;
        node = goes_first ? node + 1 : scene->light_nodes[node].second_child;
    }
    return scene->light_nodes[node].emitter;
}

/// The probability with which choose_in_light_tree() picks the light at `index` of the table.
static inline float light_tree_probability(const SceneView* scene, uint index, float3 x, float3 n) {
    uint way = scene->emitters[index].tree_way;
    uint node = 0;
    float probability = 1.0f;
    while (scene->light_nodes[node].second_child != 0) {
        const float first = first_child_probability(scene, node, x, n);
        if (first < 0.0f) {
            return 0.0f;
        }
        probability *= way & 1u ? 1.0f - first : first;
        node = way & 1u ? scene->light_nodes[node].second_child : node + 1;
        way >>= 1;
    }
    return probability;
}

#endif
