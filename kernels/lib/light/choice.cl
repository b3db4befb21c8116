// SPDX-License-Identifier: Apache-2.0
// The table of lights: which are summed exactly, and how one of the others is chosen by chance.
#ifndef NEARLIGHT_LIB_LIGHT_CHOICE
#define NEARLIGHT_LIB_LIGHT_CHOICE

#include "lib/light/tree.cl"

/// How many delta lights, the first ones of the table, are few enough to be summed all.
static inline uint exact_light_count(const SceneView* scene) {
    const uint count = scene->info->delta_emitter_count;
    return count <= NEARLIGHT_MAX_EXACT_LIGHTS ? count : 0;
}

/// The first emitter of the table with u < cdf, or the last one if rounding leaves u above all entries.
static inline uint choose_emitter(const SceneView* scene, float u) {
    uint low = 0;
    uint high = scene->info->emitter_count - 1;
    while (low < high) {
        const uint middle = (low + high) / 2;
        if (u < scene->emitters[middle].cdf) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

/// The part of the distribution that belongs to lights which are summed exactly.
static inline float exact_share(const SceneView* scene) {
    const uint count = exact_light_count(scene);
    return count == 0 ? 0.0f : scene->emitters[count - 1].cdf;
}

/// A part of the distribution.
typedef struct CdfRange {
    float low, high;
} CdfRange;

/// Whether the light is a triangle, sphere or cylinder.
static inline bool is_area_light(const global Emitter* emitter) {
    return emitter->type == NEARLIGHT_EMITTER_TRIANGLE || emitter->type == NEARLIGHT_EMITTER_SPHERE ||
           emitter->type == NEARLIGHT_EMITTER_CYLINDER;
}

/// Whether the light is the environment's map or its sun, which share a direction: a sample of either brings
/// the radiance of both, and has the density of both.
static inline bool is_distant(const global Emitter* emitter) {
    return emitter->type == NEARLIGHT_EMITTER_ENVIRONMENT || emitter->type == NEARLIGHT_EMITTER_SUN;
}

static inline bool has_light_tree(const SceneView* scene) {
    return scene->info->tree_first < scene->info->tree_end;
}

/// The part of the distribution that belongs to the lights of the tree.
static inline CdfRange tree_share(const SceneView* scene) {
    const uint first = scene->info->tree_first;
    CdfRange share;
    share.low = first == 0 ? 0.0f : scene->emitters[first - 1].cdf;
    share.high = scene->emitters[scene->info->tree_end - 1].cdf;
    return share;
}

/// Chooses among the lights that are not summed exactly; there must be one. The lights of the tree together
/// have the part of their kinds, and the tree chooses among them. `probability` gets that of the choice.
/// Returns ~0u if the choice brings nothing.
static inline uint choose_light(const SceneView* scene, const LightReceiver* at, float u,
                                float* probability) {
    const float low = exact_share(scene);
    const float place = low + u * (1.0f - low);
    if (has_light_tree(scene)) {
        const CdfRange share = tree_share(scene);
        if (place >= share.low && (place < share.high || share.high >= 1.0f)) {
            const float width = share.high - share.low;
            const float within = fmin((place - share.low) / width, 0x1.fffffep-1f);
            const uint index = choose_in_light_tree(scene, at, within, probability);
            *probability *= width / (1.0f - low);
            return index;
        }
    }
    const uint index = max(choose_emitter(scene, place), exact_light_count(scene));
    *probability = scene->emitters[index].probability / (1.0f - low);
    return index;
}

/// The probability with which choose_light() picks this entry of the table.
static inline float choice_probability(const SceneView* scene, uint index, const LightReceiver* at) {
    if (index < exact_light_count(scene)) {
        return 0.0f;
    }
    const float sampled_share = 1.0f - exact_share(scene);
    if (index >= scene->info->tree_first && index < scene->info->tree_end) {
        const CdfRange share = tree_share(scene);
        return light_tree_probability(scene, index, at) * (share.high - share.low) / sampled_share;
    }
    return scene->emitters[index].probability / sampled_share;
}

/// The entry of a triangle in the table, by itself or as a part of a sphere or cylinder, or ~0u for a
/// triangle that does not emit. Area lights lie in the table by ascending triangles, between the delta lights
/// and the lights of the sky.
static inline uint emitter_of_triangle(const SceneView* scene, uint triangle) {
    const uint first = scene->info->delta_emitter_count;
    uint low = first;
    uint high = scene->info->emitter_count;
    while (low < high) {
        const uint middle = (low + high) / 2;
        const global Emitter* emitter = scene->emitters + middle;
        if (is_area_light(emitter) && emitter->triangle <= triangle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    if (low == first) {
        return ~0u;
    }
    const global Emitter* found = scene->emitters + low - 1;
    return triangle - found->triangle < found->triangle_count ? low - 1 : ~0u;
}

#endif
