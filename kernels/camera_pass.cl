// SPDX-License-Identifier: Apache-2.0
// Camera pass: follows camera paths through glass, mirrors and coats to the first diffuse surface (the
// G-buffer).
//
// Receivers are in this order: packet = ((tile · sample_count) + sample) · branch_count + branch, where tile
// = row of tiles × tiles_x + column, counted from the first tile row of the band, and lane = row within the
// tile · NEARLIGHT_TILE_SIZE + column. Each sample has branch_count (1 or 2) receivers. At the first surface
// with two ways on (a coat, glass), branch 0 takes the base or the refraction and branch 1 the reflection,
// each with its full weight, which keeps noise out of glossy floors. At later surfaces the way is chosen by
// chance. Branch 1 of a sample that never divides is absent. One work-item for each sample, with all its
// branches; any work-group size. Random numbers depend on pixel and sample only.

#include "lib/camera.cl"
#include "lib/close_range.cl"
#include "lib/emitter.cl"
#include "lib/fresnel.cl"
#include "lib/material.cl"

#define MAX_CHAIN 24
#define MAX_HIDDEN 256  // emitters that one camera ray looks through where they are hidden

typedef struct CameraPath {
    float3 origin;
    float3 direction;
    float3 throughput;
    float3 emitted;
    uint key;        // key of the random sequence
    uint undivided;  // 1: there are two branches, and no surface with two ways on was met yet
    float t_min;     // where the first surface may lie on the ray
    float t_max;
    float filter_weight;
    uint flags;  // NEARLIGHT_VERTEX_OWN_PIXEL or 0
} CameraPath;

/// Chooses between reflection (true) and the other way. The first division gives each branch one way with its
/// full weight. Later ones choose by chance, reflection with probability p.
inline bool choose_reflection(CameraPath* path, uint branch, float p, float u) {
    if (path->undivided) {
        path->undivided = 0;
        if (branch == 1) {
            path->emitted = (float3)(0.0f);  // what was seen so far is counted by branch 0
        }
        return branch == 1;
    }
    const bool reflection = u < p;
    path->throughput *= 1.0f / (reflection ? p : 1.0f - p);
    return reflection;
}

/// A microfacet normal that the viewer sees, for roughness alpha.
inline float3 sample_facet(float3 n, float3 to_viewer, float alpha, float2 u) {
    if (alpha < 1e-3f) {
        return n;
    }
    const Frame frame = make_frame(n);
    float3 viewer = world_to_frame(&frame, to_viewer);
    viewer.z = fmax(viewer.z, 1e-4f);
    return frame_to_world(&frame, sample_visible_normal(normalize(viewer), alpha, u));
}

/// Turns the path into the mirror direction about the facet. Returns false where that goes below the surface.
inline bool reflect_path(const SceneView* scene, CameraPath* path, const SurfaceHit* hit, float3 n,
                         float3 facet, float alpha, float3 weight) {
    const float3 to_viewer = -path->direction;
    const float3 reflected = 2.0f * dot(to_viewer, facet) * facet - to_viewer;
    const float cosine = dot(reflected, n);
    if (!(cosine > 0.0f) || !(dot(reflected, hit->geometric) > 0.0f)) {
        return false;
    }
    path->throughput *= weight * (alpha < 1e-3f ? 1.0f : ggx_masking(cosine, alpha));
    path->direction = normalize(reflected);
    path->origin = offset_point(scene, hit->position, hit->geometric);
    return true;
}

/// Follows the path at metal, which only reflects. Returns false where the path ends.
inline bool scatter_conductor(const SceneView* scene, CameraPath* path, const SurfaceHit* hit,
                              const global Material* material, float3 n, float2 u) {
    const float3 facet = sample_facet(n, -path->direction, material->roughness, u);
    const float cosine = fmax(dot(-path->direction, facet), 0.0f);
    const float3 weight =
        load3(material->specular) * fresnel_conductor(cosine, load3(material->eta), load3(material->k));
    return reflect_path(scene, path, hit, n, facet, material->roughness, weight);
}

/// Follows the path at solid glass, by reflection or refraction. Returns false where the path ends.
inline bool scatter_dielectric(const SceneView* scene, CameraPath* path, const SurfaceHit* hit,
                               const global Material* material, float3 n, uint branch, float2 u_facet,
                               float u_choice) {
    const float eta = hit->front ? material->eta.x : 1.0f / material->eta.x;
    const float3 facet = sample_facet(n, -path->direction, material->roughness, u_facet);
    const float cosine = fmax(dot(-path->direction, facet), 0.0f);
    float cos_far;
    const float reflectance = fresnel_dielectric(cosine, eta, &cos_far);
    if (reflectance >= 1.0f) {
        return reflect_path(scene, path, hit, n, facet, material->roughness, load3(material->specular));
    }
    if (choose_reflection(path, branch, reflectance, u_choice)) {
        return reflect_path(scene, path, hit, n, facet, material->roughness,
                            load3(material->specular) * reflectance);
    }
    const float3 refracted = normalize(path->direction / eta + (cosine / eta - cos_far) * facet);
    const float cosine_below = -dot(refracted, n);
    if (!(cosine_below > 0.0f) || !(dot(refracted, hit->geometric) < 0.0f)) {
        return false;
    }
    const float masking = material->roughness < 1e-3f ? 1.0f : ggx_masking(cosine_below, material->roughness);
    path->throughput *= load3(material->transmission) * ((1.0f - reflectance) * masking);
    path->direction = refracted;
    path->origin = offset_point(scene, hit->position, -hit->geometric);
    return true;
}

/// Follows the path at a pane, which counts as both its faces at once and does not bend it. Returns false
/// where the path ends.
inline bool scatter_thin_dielectric(const SceneView* scene, CameraPath* path, const SurfaceHit* hit,
                                    const global Material* material, float3 n, uint branch, float u_choice) {
    float cos_far;
    const float once = fresnel_dielectric(fmax(dot(-path->direction, n), 0.0f), material->eta.x, &cos_far);
    const float reflectance = once >= 1.0f ? 1.0f : 2.0f * once / (1.0f + once);
    if (choose_reflection(path, branch, reflectance, u_choice)) {
        return reflect_path(scene, path, hit, n, n, 0.0f, load3(material->specular) * reflectance);
    }
    path->throughput *= load3(material->transmission) * (1.0f - reflectance);
    path->origin = offset_point(scene, hit->position, -hit->geometric);
    return true;
}

/// Follows the path over one surface. Returns 1 if it goes on, 0 if it ends without a receiver, and 2 if this
/// surface is the receiver; then `albedo` gets what the camera sees there.
inline uint scatter(const SceneView* scene, CameraPath* path, const SurfaceHit* hit, uint branch, uint step,
                    float3* albedo) {
    const global Material* material = scene->materials + hit->material;
    const float2 u_facet = sample_2d(0, 2 * step + 1, path->key);
    const float u_choice = sample_2d(0, 2 * step + 2, path->key).x;
    const float3 n = dot(hit->shading, path->direction) < 0.0f ? hit->shading : hit->geometric;
    switch (material->lobe) {
        case NEARLIGHT_LOBE_CONDUCTOR:
            return reflects(material, hit->front) &&
                   scatter_conductor(scene, path, hit, material, n, u_facet);
        case NEARLIGHT_LOBE_DIELECTRIC:
            return scatter_dielectric(scene, path, hit, material, n, branch, u_facet, u_choice);
        case NEARLIGHT_LOBE_THIN_DIELECTRIC:
            return scatter_thin_dielectric(scene, path, hit, material, n, branch, u_choice);
        default:
            break;
    }
    if (!reflects(material, hit->front)) {
        return 0;
    }
    *albedo = camera_albedo(scene, material, hit->uv);
    if (material->lobe == NEARLIGHT_LOBE_COAT) {
        const float3 facet = sample_facet(n, -path->direction, material->roughness, u_facet);
        float cos_far;
        const float facet_reflectance =
            fresnel_dielectric(fmax(dot(-path->direction, facet), 0.0f), material->eta.x, &cos_far);
        const float reflectance =
            fresnel_dielectric(fmax(dot(-path->direction, n), 0.0f), material->eta.x, &cos_far);
        const float p =
            clamp(reflectance / (reflectance + (1.0f - reflectance) * luminance(*albedo)), 0.05f, 0.95f);
        if (choose_reflection(path, branch, p, u_choice)) {
            return reflect_path(scene, path, hit, n, facet, material->roughness,
                                load3(material->specular) * facet_reflectance);
        }
        *albedo *= 1.0f - reflectance;
    }
    return 2;
}

/// Where a camera path ends, and what it saw on the way.
typedef struct CameraReceiver {
    float3 position, normal;  // zero normal: there is no receiver
    CameraVertex vertex;
} CameraReceiver;

inline CameraReceiver absent_receiver(void) {
    CameraReceiver receiver;
    receiver.position = (float3)(0.0f);
    receiver.normal = (float3)(0.0f);
    receiver.vertex.throughput = store3((float3)(0.0f));
    receiver.vertex.depth = 0.0f;
    receiver.vertex.albedo = store3((float3)(0.0f));
    receiver.vertex.flags = 0;
    receiver.vertex.emitted = store3((float3)(0.0f));
    receiver.vertex.filter_weight = 0.0f;
    return receiver;
}

inline CameraPath start_path(const global Camera* camera, uint x, uint y, uint sample, uint sequence_length,
                             uint branch_count, uint seed) {
    const uint pixel = y * camera->width + x;
    CameraPath path;
    path.key = random_uint4((uint4)(pixel, sample, seed, 0xca3e7au)).x;
    const uint pixel_key = random_uint4((uint4)(pixel, seed, 0xf117u, 0x37u)).x;
    // A single sample goes through the centre of its pixel, but through any part of the lens.
    const FilmSample film = sequence_length > 1 ? sample_film(camera, x, y, sample_2d(sample, 0, pixel_key))
                                                : middle_of_pixel(x, y);
    const CameraRay ray = camera_ray(camera, film.position, sample_2d(sample, 1, pixel_key));
    path.origin = ray.origin;
    path.direction = ray.direction;
    path.t_min = ray.t_min;
    path.t_max = ray.t_max;
    path.throughput = (float3)(1.0f);
    path.emitted = (float3)(0.0f);
    path.undivided = branch_count > 1;
    path.filter_weight = film.weight;
    path.flags = film.is_in_own_pixel ? NEARLIGHT_VERTEX_OWN_PIXEL : 0;
    return path;
}

inline bool is_emitter(const SceneView* scene, const SurfaceHit* hit) {
    return max_component(load3(scene->materials[hit->material].emission)) > 0.0f;
}

/// The first surface that the camera sees. Where emitters are hidden, it lies behind all of them, and clip
/// planes end at the first one, as in Mitsuba.
inline SurfaceHit trace_first(const SceneView* scene, const global Camera* camera, const CameraPath* path) {
    SurfaceHit hit = trace_camera(scene, path->origin, path->direction, path->t_min, path->t_max);
    for (uint i = 0; camera->hides_emitters && hit.t >= 0.0f && is_emitter(scene, &hit); ++i) {
        const float passed = hit.t;
        const float3 origin = offset_point(scene, hit.position, -hit.geometric);
        hit = i < MAX_HIDDEN ? trace_camera(scene, origin, path->direction, 0.0f, INFINITY) : no_surface();
        hit.t += hit.t >= 0.0f ? passed : 0.0f;
    }
    return hit;
}

/// Follows one branch to its receiver. Branch 0 sets `first` to the first surface that it meets, and branch 1
/// takes it from there.
inline CameraReceiver follow_path(const SceneView* scene, const global Camera* camera,
                                  const global CloseRange* close_range, CameraPath* path, uint branch,
                                  SurfaceHit* first) {
    CameraReceiver receiver = absent_receiver();
    receiver.vertex.filter_weight = path->filter_weight;
    const float3 straight = path->direction;
    bool sees_sky = !camera->hides_emitters;
    float3 albedo = (float3)(0.0f);
    for (uint step = 0; step < MAX_CHAIN; ++step) {
        SurfaceHit hit;
        if (step == 0) {
            hit = branch == 1 ? *first : trace_first(scene, camera, path);
            *first = hit;
        } else {
            hit = trace_camera(scene, path->origin, path->direction, 0.0f, INFINITY);
        }
        if (hit.t < 0.0f) {
            if (sees_sky) {
                path->emitted += path->throughput * environment_radiance(scene, path->direction);
            }
            break;
        }
        if (step == 0) {
            receiver.vertex.depth = hit.t;
            receiver.vertex.flags = path->flags;
        }
        if (hit.front) {
            path->emitted += path->throughput * load3(scene->materials[hit.material].emission);
        }
        const uint outcome = scatter(scene, path, &hit, branch, step, &albedo);
        if (outcome == 2) {
            receiver.position = offset_point(scene, hit.position, hit.geometric);
            receiver.normal = hit.shading;
            receiver.vertex.throughput = store3(path->throughput);
            receiver.vertex.albedo = store3(albedo);
            receiver.vertex.flags |= in_close_range(close_range, hit.position) ? NEARLIGHT_VERTEX_CLOSE : 0;
        }
        if (outcome != 1) {
            break;
        }
        // A pane that does not turn the path hides no less than air does, as in Mitsuba.
        sees_sky = sees_sky || any(path->direction != straight);
    }
    receiver.vertex.emitted = store3(path->emitted);
    return receiver;
}

/// Turns what branch 0 met into branch 1 of a path that never divides, which is absent and brings no light.
inline void leave_to_branch_0(CameraReceiver* receiver) {
    receiver->vertex.throughput = store3((float3)(0.0f));
    receiver->vertex.albedo = store3((float3)(0.0f));
    receiver->vertex.emitted = store3((float3)(0.0f));
    receiver->normal = (float3)(0.0f);
}

inline void store_receiver(const CameraReceiver* from, global ReceiverPacket* to, uint lane,
                           global CameraVertex* vertex) {
    to->px[lane] = from->position.x;
    to->py[lane] = from->position.y;
    to->pz[lane] = from->position.z;
    to->nx[lane] = from->normal.x;
    to->ny[lane] = from->normal.y;
    to->nz[lane] = from->normal.z;
    *vertex = from->vertex;
}

kernel void camera_pass(SCENE_PARAMETERS, const global Camera* restrict camera,
                        const global CloseRange* restrict close_range, uint first_tile_row,
                        uint tile_row_count, uint first_sample, uint sample_count, uint sequence_length,
                        uint branch_count, uint seed, global ReceiverPacket* restrict receivers,
                        global CameraVertex* restrict vertices) {
    const uint index = (uint)get_global_id(0);
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    const uint sample = index / NEARLIGHT_PACKET_SIZE % sample_count;
    const uint tile = index / NEARLIGHT_PACKET_SIZE / sample_count;
    const uint tiles_x = tiles_across(camera->width);
    if (tile >= tiles_x * tile_row_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const uint x = tile % tiles_x * NEARLIGHT_TILE_SIZE + lane % NEARLIGHT_TILE_SIZE;
    const uint y = (first_tile_row + tile / tiles_x) * NEARLIGHT_TILE_SIZE + lane / NEARLIGHT_TILE_SIZE;
    const bool in_picture = x < camera->width && y < camera->height;
    const CameraPath start =
        start_path(camera, x, y, first_sample + sample, sequence_length, branch_count, seed);
    CameraReceiver receiver = absent_receiver();
    SurfaceHit first;
    bool divided = false;
    for (uint branch = 0; branch < branch_count; ++branch) {
        if (in_picture && (branch == 0 || divided)) {
            CameraPath path = start;
            receiver = follow_path(&scene, camera, close_range, &path, branch, &first);
            divided = !path.undivided;
        } else if (branch == 1) {
            leave_to_branch_0(&receiver);
        }
        const uint packet = (tile * sample_count + sample) * branch_count + branch;
        store_receiver(&receiver, receivers + packet, lane,
                       vertices + (size_t)packet * NEARLIGHT_PACKET_SIZE + lane);
    }
}
