// SPDX-License-Identifier: Apache-2.0
// The scene as kernels see it: a parameter list, a struct of pointers, and what a ray finds on a surface.
//
// A kernel declares SCENE_PARAMETERS and collects them with `const SceneView scene = SCENE_VIEW;`. The host
// passes a DeviceScene, which sets the same arguments in the same order (host/stages/device_scene.h).
#ifndef NEARLIGHT_LIB_SCENE
#define NEARLIGHT_LIB_SCENE

#include "lib/ray_tree.cl"

#define SCENE_PARAMETERS                                                                                     \
    const global TreeNode *restrict scene_nodes, const global TreeTriangles *restrict scene_tree_triangles,  \
        const global uint *restrict scene_triangle_ids, const global TreeNode *restrict scene_glass_nodes,   \
        const global TreeTriangles *restrict scene_glass_triangles,                                          \
        const global uint *restrict scene_glass_ids, const global Vertex *restrict scene_vertices,           \
        const global Triangle *restrict scene_triangles, const global Material *restrict scene_materials,    \
        const global Texture *restrict scene_textures, const global uint *restrict scene_texels,             \
        const global Emitter *restrict scene_emitters, const global Environment *restrict scene_environment, \
        const global float4 *restrict scene_environment_pixels, const global float *restrict scene_row_cdf,  \
        const global float *restrict scene_column_cdf, const global LightNode *restrict scene_light_nodes,   \
        const global SceneInfo *restrict scene_info
#define SCENE_VIEW                                                                                           \
    {                                                                                                        \
        scene_nodes, scene_tree_triangles, scene_triangle_ids, scene_glass_nodes, scene_glass_triangles,     \
            scene_glass_ids, scene_vertices, scene_triangles, scene_materials, scene_textures, scene_texels, \
            scene_emitters, scene_environment, scene_environment_pixels, scene_row_cdf, scene_column_cdf,    \
            scene_light_nodes, scene_info                                                                    \
    }

typedef struct SceneView {
    const global TreeNode* nodes;  // tree of the opaque triangles
    const global TreeTriangles* tree_triangles;
    const global uint* triangle_ids;  // index into `triangles` for each slot of the tree
    const global TreeNode* glass_nodes;
    const global TreeTriangles* glass_triangles;
    const global uint* glass_ids;
    const global Vertex* vertices;
    const global Triangle* triangles;
    const global Material* materials;
    const global Texture* textures;
    const global uint* texels;
    const global Emitter* emitters;
    const global Environment* environment;
    const global float4* environment_pixels;
    const global float* row_cdf;
    const global float* column_cdf;
    const global LightNode* light_nodes;
    const global SceneInfo* info;
} SceneView;

/// What a ray found. Normals are unit vectors on the side that the ray came from.
typedef struct SurfaceHit {
    float t;           // in units of the direction's length; < 0: no hit
    float3 position;   // on the surface
    float3 geometric;  // normal of the triangle
    float3 shading;    // interpolated normal; the geometric one where the mesh has none
    float2 uv;         // texture coordinates
    uint triangle;     // index into SceneView.triangles
    uint material;
    uint front;  // 1: the ray met the front
} SurfaceHit;

inline SurfaceHit make_surface_hit(const SceneView* scene, const TreeTriangle* of_tree, uint triangle_id,
                                   float3 direction, RayHit ray_hit) {
    SurfaceHit hit;
    const float u = ray_hit.u;
    const float v = ray_hit.v;
    const Triangle triangle = scene->triangles[triangle_id];
    const global Vertex* a = scene->vertices + triangle.v0;
    const global Vertex* b = scene->vertices + triangle.v1;
    const global Vertex* c = scene->vertices + triangle.v2;
    const float w = 1.0f - u - v;
    hit.t = ray_hit.t;
    // The position comes from the triangle and not from the ray, so that it is as exact as the vertices are.
    hit.position = of_tree->v0 + u * of_tree->edge1 + v * of_tree->edge2;
    const float3 normal = normalize(of_tree->normal);
    hit.front = dot(normal, direction) < 0.0f;
    hit.geometric = hit.front ? normal : -normal;
    const float3 interpolated = w * load3(a->normal) + u * load3(b->normal) + v * load3(c->normal);
    const float squared = dot(interpolated, interpolated);
    const float3 smooth = squared > 1e-12f ? interpolated * rsqrt(squared) : normal;
    hit.shading = dot(smooth, hit.geometric) < 0.0f ? -smooth : smooth;
    hit.uv = (float2)(w * a->u + u * b->u + v * c->u, w * a->v + u * b->v + v * c->v);
    hit.triangle = triangle_id;
    hit.material = triangle.material;
    return hit;
}

inline SurfaceHit no_surface(void) {
    SurfaceHit none;
    none.t = -1.0f;
    return none;
}

/// The nearest opaque surface on a ray before t_max. Its t is negative if there is none.
inline SurfaceHit trace_opaque(const SceneView* scene, float3 origin, float3 direction, float t_max) {
    const RayHit hit = tree_closest_hit(scene->nodes, scene->tree_triangles, origin, direction, 0.0f, t_max);
    if (hit.slot == ~0u) {
        return no_surface();
    }
    const TreeTriangle triangle = tree_triangle(scene->tree_triangles, hit.slot);
    return make_surface_hit(scene, &triangle, scene->triangle_ids[hit.slot], direction, hit);
}

/// The nearest surface on a ray, glass included, for camera paths only. Its t is negative if there is none.
inline SurfaceHit trace_camera(const SceneView* scene, float3 origin, float3 direction) {
    const global TreeTriangles* triangles = scene->tree_triangles;
    const global uint* ids = scene->triangle_ids;
    RayHit hit = tree_closest_hit(scene->nodes, triangles, origin, direction, 0.0f, INFINITY);
    if (scene->info->has_glass) {
        const RayHit glass =
            tree_closest_hit(scene->glass_nodes, scene->glass_triangles, origin, direction, 0.0f, hit.t);
        if (glass.slot != ~0u) {
            hit = glass;
            triangles = scene->glass_triangles;
            ids = scene->glass_ids;
        }
    }
    if (hit.slot == ~0u) {
        return no_surface();
    }
    const TreeTriangle triangle = tree_triangle(triangles, hit.slot);
    return make_surface_hit(scene, &triangle, ids[hit.slot], direction, hit);
}

/// True if no opaque surface lies between two points that both stand off their surfaces.
inline bool is_visible(const SceneView* scene, float3 from, float3 to) {
    return !tree_occluded(scene->nodes, scene->tree_triangles, from, to - from, NEARLIGHT_SEGMENT_T_MIN,
                          NEARLIGHT_SEGMENT_T_MAX);
}

inline float3 offset_point(const SceneView* scene, float3 position, float3 normal) {
    return position + ray_epsilon(position, scene->info->extent) * normal;
}

#endif
