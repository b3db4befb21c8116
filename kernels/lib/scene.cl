// SPDX-License-Identifier: Apache-2.0
// The scene as kernels see it: a parameter list, a struct of pointers, and what a ray finds on a surface.
//
// A kernel declares SCENE_PARAMETERS and collects them with `const SceneView scene = SCENE_VIEW;`. The host
// passes a DeviceScene, which sets the same arguments in the same order (host/stages/device_scene.h).
#ifndef NEARLIGHT_LIB_SCENE
#define NEARLIGHT_LIB_SCENE

#include "lib/ray_tree.cl"
#include "shared/light.h"

#define SCENE_PARAMETERS                                                                                    \
    const global TreeNode *restrict scene_nodes, const global TreeTriangles *restrict scene_tree_triangles, \
        const global uint *restrict scene_triangle_ids, const global Vertex *restrict scene_vertices,       \
        const global Triangle *restrict scene_triangles, const global Material *restrict scene_materials,   \
        const global Texture *restrict scene_textures, const global uint *restrict scene_texels,            \
        const global Vec3 *restrict scene_vertex_colors, const global float2 *restrict scene_second_uvs,    \
        const global float *restrict scene_curves, const global Emitter *restrict scene_emitters,           \
        const global Environment *restrict scene_environment,                                               \
        const global float4 *restrict scene_environment_pixels, const global float *restrict scene_row_cdf, \
        const global float *restrict scene_column_cdf, const global float *restrict scene_row_cosines,      \
        const global uint *restrict scene_block_details, const global float *restrict scene_detail_cdf,     \
        const global LightNode *restrict scene_light_nodes, const global SceneInfo *restrict scene_info,    \
        const global TreeTriangles *restrict scene_solids
#define SCENE_VIEW                                                                                         \
    {                                                                                                      \
        scene_nodes, scene_tree_triangles, scene_triangle_ids, scene_vertices, scene_triangles,            \
            scene_materials, scene_textures, scene_texels, scene_vertex_colors, scene_second_uvs,          \
            scene_curves, scene_emitters, scene_environment, scene_environment_pixels, scene_row_cdf,      \
            scene_column_cdf, scene_row_cosines, scene_block_details, scene_detail_cdf, scene_light_nodes, \
            scene_info, scene_solids                                                                       \
    }

/// The tree of a scene's veils alone, and the scene as rays see it that meet nothing else.
#define VEIL_PARAMETERS                                                                                   \
    const global TreeNode *restrict veil_nodes, const global TreeTriangles *restrict veil_tree_triangles, \
        const global uint *restrict veil_triangle_ids
#define VEIL_VIEW(scene) veils_alone(scene, veil_nodes, veil_tree_triangles, veil_triangle_ids)

typedef struct SceneView {
    const global TreeNode* nodes;
    const global TreeTriangles* tree_triangles;
    const global uint* triangle_ids;  // index into `triangles` for each slot of the tree
    const global Vertex* vertices;
    const global Triangle* triangles;
    const global Material* materials;
    const global Texture* textures;
    const global uint* texels;
    const global Vec3* vertex_colors;  // one a vertex, where the scene has them
    const global float2* second_uvs;   // one a vertex, where the scene has them
    const global float* curves;        // transmission curves, NEARLIGHT_CURVE_SIZE values each
    const global Emitter* emitters;
    const global Environment* environment;
    const global float4* environment_pixels;
    const global float* row_cdf;     // of the environment's rows of blocks (light/environment.cl)
    const global float* column_cdf;  // of the blocks of each row
    // Cosines of the polar angles where rows of pixels begin, and where the last row ends.
    const global float* row_cosines;
    const global uint* block_details;  // for each block, where its part of detail_cdf begins
    const global float* detail_cdf;    // of the rows of a block, and then of the pixels of each row
    const global LightNode* light_nodes;
    const global SceneInfo* info;
    const global TreeTriangles* solids;  // those of `tree_triangles` that are no veils, in the same slots
} SceneView;

/// The scene as rays see it that pass all veils.
static inline SceneView solids_alone(SceneView scene) {
    scene.tree_triangles = scene.solids;
    return scene;
}

static inline SceneView veils_alone(SceneView scene, const global TreeNode* nodes,
                                    const global TreeTriangles* triangles, const global uint* triangle_ids) {
    scene.nodes = nodes;
    scene.tree_triangles = triangles;
    scene.triangle_ids = triangle_ids;
    return scene;
}

/// What a ray found. Normals are unit vectors.
typedef struct SurfaceHit {
    float t;           // in units of the direction's length; < 0: no hit
    float3 position;   // on the surface
    float3 geometric;  // normal of the triangle, on the side that the ray came from
    float3 shading;    // interpolated normal on the front; the triangle's own where the mesh has none
    float2 weights;    // weights of v1 and v2
    float2 uv;         // texture coordinates
    uint triangle;     // index into SceneView.triangles
    uint material;
    uint front;       // 1: the ray met the front
    float stand_off;  // how far from the surface rays start that leave it, m
} SurfaceHit;

/// How far from a triangle rays start that leave it, in metres. host/scene/ray_epsilon.h has the same formula
/// and says what its parts are for.
static inline float triangle_stand_off(const SceneView* scene, uint triangle_id) {
    const Triangle triangle = scene->triangles[triangle_id];
    const float3 a = load3(scene->vertices[triangle.v0].position);
    const float3 b = load3(scene->vertices[triangle.v1].position);
    const float3 c = load3(scene->vertices[triangle.v2].position);
    const float3 edge1 = b - a;
    const float3 edge2 = c - a;
    const float3 across = cross(edge1, edge2);
    const float inverse = rsqrt(dot(across, across));
    const float3 n = fabs(across) * inverse;
    const float3 magnitude = fmax(fabs(a), fmax(fabs(b), fabs(c)));
    const float3 e1 = fabs(edge1);
    const float3 e2 = fabs(edge2);
    const float3 products = e1.yzx * e2.zxy + e1.zxy * e2.yzx;
    const float largest = max_component(magnitude);
    const float rounding = 1e-6f * (dot(n, magnitude) + dot(fmax(e1, e2), products) * inverse) +
                           5e-8f * largest +
                           4e-7f * dot(n, fmin(load3(scene->info->size), (float3)(64.0f * largest)));
    return fmin(rounding, ray_epsilon(magnitude, scene->info->extent));
}

/// The surface at a point of a triangle, met from the front or from the back. `normal` is that of the
/// triangle's front, and `t` is left 0.
static inline SurfaceHit surface_at(const SceneView* scene, uint triangle_id, float2 weights, float3 position,
                                    float3 normal, bool front) {
    SurfaceHit hit;
    const float u = weights.x;
    const float v = weights.y;
    const float w = 1.0f - u - v;
    const Triangle triangle = scene->triangles[triangle_id];
    const global Vertex* a = scene->vertices + triangle.v0;
    const global Vertex* b = scene->vertices + triangle.v1;
    const global Vertex* c = scene->vertices + triangle.v2;
    hit.t = 0.0f;
    hit.position = position;
    hit.front = front;
    hit.geometric = front ? normal : -normal;
    const float3 interpolated = w * load3(a->normal) + u * load3(b->normal) + v * load3(c->normal);
    const float squared = dot(interpolated, interpolated);
    hit.shading = squared > 1e-12f ? interpolated * rsqrt(squared) : normal;
    hit.weights = weights;
    hit.uv = (float2)(w * a->u + u * b->u + v * c->u, w * a->v + u * b->v + v * c->v);
    hit.triangle = triangle_id;
    hit.material = triangle.material;
    hit.stand_off = triangle_stand_off(scene, triangle_id);
    return hit;
}

/// The surface at a point of a triangle, met by a ray along `direction`; t is left 0.
static inline SurfaceHit surface_met_at(const SceneView* scene, uint triangle_id, float2 weights,
                                        float3 direction) {
    const Triangle triangle = scene->triangles[triangle_id];
    const float3 corner = load3(scene->vertices[triangle.v0].position);
    const float3 edge1 = load3(scene->vertices[triangle.v1].position) - corner;
    const float3 edge2 = load3(scene->vertices[triangle.v2].position) - corner;
    const float3 normal = normalize(cross(edge1, edge2));
    const bool front = dot(direction, normal) < 0.0f;
    return surface_at(scene, triangle_id, weights, corner + weights.x * edge1 + weights.y * edge2, normal,
                      front);
}

static inline SurfaceHit make_surface_hit(const SceneView* scene, const TreeTriangle* of_tree,
                                          uint triangle_id, float3 direction, RayHit ray_hit) {
    const float3 normal = normalize(of_tree->normal);
    // The position comes from the triangle and not from the ray, so that it is as exact as the vertices are.
    const float3 position = of_tree->v0 + ray_hit.u * of_tree->edge1 + ray_hit.v * of_tree->edge2;
    SurfaceHit hit = surface_at(scene, triangle_id, (float2)(ray_hit.u, ray_hit.v), position, normal,
                                dot(normal, direction) < 0.0f);
    hit.t = ray_hit.t;
    return hit;
}

static inline SurfaceHit no_surface(void) {
    SurfaceHit none;
    none.t = -1.0f;
    return none;
}

/// The nearest surface on a ray from t_min to t_max. Its t is negative if there is none.
static inline SurfaceHit trace_between(const SceneView* scene, float3 origin, float3 direction, float t_min,
                                       float t_max) {
    const RayHit hit = tree_closest_hit(scene->nodes, scene->tree_triangles, origin, direction, t_min, t_max);
    if (hit.slot == ~0u) {
        return no_surface();
    }
    const TreeTriangle triangle = tree_triangle(scene->tree_triangles, hit.slot);
    return make_surface_hit(scene, &triangle, scene->triangle_ids[hit.slot], direction, hit);
}

/// The nearest surface on a ray before t_max. Its t is negative if there is none.
static inline SurfaceHit trace_surface(const SceneView* scene, float3 origin, float3 direction, float t_max) {
    return trace_between(scene, origin, direction, 0.0f, t_max);
}

/// True if no surface lies between two points that both stand off their surfaces.
static inline bool is_visible(const SceneView* scene, float3 from, float3 to) {
    return !tree_occluded(scene->nodes, scene->tree_triangles, from, to - from, NEARLIGHT_SEGMENT_T_MIN,
                          NEARLIGHT_SEGMENT_T_MAX);
}

/// The point off a surface where it was hit, on the side of the unit vector `side`, which is its normal or
/// the opposite.
static inline float3 off_surface(const SurfaceHit* hit, float3 side) {
    return hit->position + hit->stand_off * side;
}

/// ray_epsilon() of a point in a scene of which only what lies about it counts: a neighbourhood of this
/// radius. However wide the surroundings of a table are, they change nothing on it.
static inline float epsilon_about(const SceneView* scene, float3 point, float radius) {
    // So the twentieth of the extent that ray_epsilon() counts is at most twice |point| + radius.
    const float extent = fmin(scene->info->extent, 40.0f * (max_component(fabs(point)) + radius));
    return ray_epsilon(point, extent);
}

/// A point on a sphere or cylinder that emits, moved off it along `outwards`.
static inline float3 off_round_light(const SceneView* scene, const global Emitter* light, float3 point,
                                     float3 outwards) {
    return point + epsilon_about(scene, point, light->radius) * outwards;
}

/// The point off a surface from which a ray in the given direction starts.
static inline float3 ray_origin(const SurfaceHit* hit, float3 direction) {
    return off_surface(hit, dot(hit->geometric, direction) > 0.0f ? hit->geometric : -hit->geometric);
}

#endif
