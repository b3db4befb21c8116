// SPDX-License-Identifier: Apache-2.0
// Shadowing by the bumps that a normal or bump map stands for. [Estevez et al., A Microfacet-Based Shadowing
// Function to Solve the Bump Terminator Problem, Ray Tracing Gems 2019]
#ifndef NEARLIGHT_LIB_MAP_SHADOWING
#define NEARLIGHT_LIB_MAP_SHADOWING

/// The squared α of the shadowing by a map whose normal has this cosine to the mesh's.
static inline float map_tilt(float cosine) {
    const float cos2 = cosine * cosine;
    return clamp(0.125f * (1.0f - cos2) / fmax(cos2, 1e-12f), 0.0f, 1.0f);
}

/// The part of light that is not in shadow, where it has this cosine to the mesh's normal.
static inline float map_shadowing(float tilt2, float cosine) {
    const float cos2 = fmax(cosine * cosine, 1e-12f);
    return 2.0f / (1.0f + sqrt(1.0f + tilt2 * fmax(1.0f - cos2, 0.0f) / cos2));
}

/// The part of light along the unit vector `direction`, towards the light, that reaches a surface whose
/// normal a map has tilted from `mesh_n` to `n`: none from behind the mesh, and all where `mesh_n` is zero,
/// because there is no map.
static inline float unshadowed_part(float3 n, float3 mesh_n, float3 direction) {
    if (!(dot(mesh_n, mesh_n) > 0.0f)) {
        return 1.0f;
    }
    const float cosine = dot(direction, mesh_n);
    return cosine > 0.0f ? map_shadowing(map_tilt(dot(n, mesh_n)), cosine) : 0.0f;
}

#endif
