// SPDX-License-Identifier: Apache-2.0
// Evaluates and samples the BSDFs of points, for checks. One work-item for each query; any
// work-group size.

#include "lib/bsdf/bsdf.cl"
#include "shared/bsdf_query.h"

kernel void bsdf_probe(const global Vertex* restrict vertices, const global Triangle* restrict triangles,
                       const global Material* restrict materials, const global Texture* restrict textures,
                       const global uint* restrict texels, const global float* restrict curves,
                       const global Vec3* restrict vertex_colors, const global float2* restrict second_uvs,
                       const global SceneInfo* restrict info, const global BsdfQuery* restrict queries,
                       global BsdfAnswer* restrict answers, uint count) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    SceneView scene;
    scene.vertices = vertices;
    scene.triangles = triangles;
    scene.materials = materials;
    scene.textures = textures;
    scene.texels = texels;
    scene.curves = curves;
    scene.vertex_colors = vertex_colors;
    scene.second_uvs = second_uvs;
    scene.info = info;
    const BsdfQuery query = queries[index];
    const float3 wo = load3(query.wo);
    const float3 wi = load3(query.wi);
    const Triangle triangle = triangles[query.triangle];
    const float3 v0 = load3(vertices[triangle.v0].position);
    TreeTriangle shape;
    shape.v0 = v0;
    shape.edge1 = load3(vertices[triangle.v1].position) - v0;
    shape.edge2 = load3(vertices[triangle.v2].position) - v0;
    shape.normal = cross(shape.edge1, shape.edge2);
    const RayHit met = {1.0f, query.weight1, query.weight2, 0u};
    const SurfaceHit hit = make_surface_hit(&scene, &shape, query.triangle, -wo, met);
    const SurfaceBsdf s = surface_bsdf(&scene, &hit, -wo, query.mode, query.choice);
    BsdfAnswer answer;
    answer.value = store3(bsdf_eval(&scene, &s, wi, query.parts, &answer.pdf));
    const BsdfSample sample = bsdf_sample(&scene, &s, query.parts, query.u, (float2)(query.v[0], query.v[1]));
    answer.wi = store3(sample.wi);
    answer.sample_pdf = sample.pdf;
    answer.weight = store3(sample.weight);
    answer.eta = sample.eta;
    answer.albedo = store3(bsdf_albedo(&scene, &s));
    answer.is_delta = sample.is_delta;
    answers[index] = answer;
}
