// SPDX-License-Identifier: Apache-2.0
// The table of lights: which are summed exactly, and how one of the others is chosen by chance.
#ifndef NEARLIGHT_LIB_LIGHT_CHOICE
#define NEARLIGHT_LIB_LIGHT_CHOICE

#include "lib/scene.cl"

/// Up to this many delta lights are all summed. If there are more, they are chosen by chance like the other
/// lights.
#define MAX_EXACT_LIGHTS 16u

/// How many delta lights, the first ones of the table, are few enough to be summed all.
inline uint exact_light_count(const SceneView* scene) {
    const uint count = scene->info->delta_emitter_count;
    return count <= MAX_EXACT_LIGHTS ? count : 0;
}

/// The first emitter of the table with u < cdf, or the last one if rounding leaves u above all entries.
inline uint choose_emitter(const SceneView* scene, float u) {
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
inline float exact_share(const SceneView* scene) {
    const uint count = exact_light_count(scene);
    return count == 0 ? 0.0f : scene->emitters[count - 1].cdf;
}

/// Chooses among the lights that are not summed exactly; there must be one. `probability` gets that of the
/// choice.
inline uint choose_light(const SceneView* scene, float u, float* probability) {
    const float low = exact_share(scene);
    const uint index = max(choose_emitter(scene, low + u * (1.0f - low)), exact_light_count(scene));
    *probability = scene->emitters[index].probability / (1.0f - low);
    return index;
}

/// The probability with which choose_light() picks this entry of the table.
inline float choice_probability(const SceneView* scene, uint index) {
    return index < exact_light_count(scene)
               ? 0.0f
               : scene->emitters[index].probability / (1.0f - exact_share(scene));
}

/// The entry of a triangle in the table, or ~0u for a triangle that does not emit. Triangles lie in the table
/// in ascending order, between the delta lights and the environment.
inline uint emitter_of_triangle(const SceneView* scene, uint triangle) {
    uint low = scene->info->delta_emitter_count;
    uint high = scene->info->emitter_count;
    while (low < high) {
        const uint middle = (low + high) / 2;
        const global Emitter* emitter = scene->emitters + middle;
        if (emitter->type == NEARLIGHT_EMITTER_TRIANGLE && emitter->triangle < triangle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    const bool is_found = low < scene->info->emitter_count &&
                          scene->emitters[low].type == NEARLIGHT_EMITTER_TRIANGLE &&
                          scene->emitters[low].triangle == triangle;
    return is_found ? low : ~0u;
}

#endif
