// SPDX-License-Identifier: Apache-2.0
// Camera pass: follows camera paths by the part S of surfaces (coats, metals, glass) to receivers, which are
// the Lambertian parts D of surfaces, and adds up the light of emitters that paths meet or find in S on the
// way.
//
// Packets of receivers are in the order of shared/packet_order.h, where rows of tiles count from the first of
// the band, and lane = row within the tile · NEARLIGHT_TILE_SIZE + column. Each sample has branch_count (1 or
// 2) receivers. At the first surface with two ways on (D and S, or glass), branch 0 takes D or the refraction
// and branch 1 S or the reflection, each with its full weight, which keeps noise out of glossy floors. At
// later surfaces the way is chosen by chance. Branch 1 of a sample that never divides is absent. A receiver
// of little weight is absent too, and so is one behind mirrors or glass to which a depth limit leaves few
// edges: their light is traced at once and added up in CameraVertex. The latter shows in the layers of
// surfaces all the same, whose normal its packet has in mesh_normal. One work-item for each sample, with all
// its branches; any work-group size. Random numbers depend on pixel and sample only.

#include "lib/camera_path.cl"
#include "lib/camera_sample.cl"
#include "lib/close_range.cl"
#include "lib/outlined.cl"
#include "lib/receiver_path.cl"
#include "lib/vpl.cl"
#include "shared/camera_pass.h"
#include "shared/shared_light.h"

#define MAX_CHAIN 255  // surfaces that ReceiverPacket.surface can count; chance ends paths long before
#define MAX_TRACED_LIGHT_SAMPLES 4  // light samples of a receiver whose light is traced at once
#define FEW_EDGES 2u  // edges left to a receiver behind mirrors or glass whose light is traced at once

/// The surface as shared_sky.cl reads it, to compute what its S reflects of the sky that its bundle finds.
static inline SeenSurface seen_surface(const SurfaceHit* hit, float3 direction, float model,
                                       uint light_samples) {
    SeenSurface seen;
    seen.triangle = hit->triangle;
    seen.u = hit->weights.x;
    seen.v = hit->weights.y;
    seen.model = model;
    seen.direction = store3(direction);
    seen.light_samples = light_samples;
    return seen;
}

/// Where a camera path ends, and what it saw on the way.
typedef struct CameraReceiver {
    float3 position, normal;  // zero normal: there is no receiver
    uint surface;             // ReceiverPacket.surface
    uint mesh_normal;         // ReceiverPacket.mesh_normal
    uint sequence;            // ReceiverPacket.sequence
    CameraVertex vertex;
    SeenSurface seen;
} CameraReceiver;

static inline CameraReceiver absent_receiver(void) {
    CameraReceiver receiver;
    receiver.position = (float3)(0.0f);
    receiver.normal = (float3)(0.0f);
    receiver.surface = 0;
    receiver.mesh_normal = receiver.sequence = 0;
    receiver.vertex.throughput = store3((float3)(0.0f));
    receiver.vertex.depth = 0.0f;
    receiver.vertex.albedo = store3((float3)(0.0f));
    receiver.vertex.flags = 0;
    receiver.vertex.camera_light = store3((float3)(0.0f));
    receiver.vertex.filter_weight = 0.0f;
    receiver.vertex.traced_direct = receiver.vertex.traced_indirect = store3((float3)(0.0f));
    receiver.vertex.film_x = receiver.vertex.film_y = 0.0f;
    receiver.seen.light_samples = 0;
    return receiver;
}

/// The key, never 0, of the random numbers of a pixel's receivers of one branch.
static inline uint sequence_key(uint pixel, uint sample, uint branch, uint seed) {
    const uint4 key = (uint4)(pixel, sample / NEARLIGHT_SEQUENCE_RECEIVERS * 2 + branch, seed, 0x5e90e2ceu);
    return max(random_uint4(key).x, 1u);
}

OUTLINED_ON_CPU CameraPath start_path(const global Camera* camera, uint x, uint y, uint sample,
                                      uint in_middle, uint branch_count, uint seed) {
    const CameraSample start = camera_sample(camera, x, y, sample, in_middle, seed);
    CameraPath path;
    path.key = start.key;
    path.pixel_key = start.pixel_key;
    path.sample = sample;
    path.ray = first_ray(start.ray.direction);
    const LightReceiver camera_place = even_receiver(start.ray.origin, start.ray.direction);
    begin_ray(&path.ray, &camera_place, 0.0f);
    path.mode = BSDF_CAMERA;
    path.t_min = start.ray.t_min;
    path.t_max = start.ray.t_max;
    path.camera_light = (float3)(0.0f);
    path.undivided = branch_count > 1;
    path.filter_weight = start.film.weight;
    path.film = start.film.position - ((float2)((float)x, (float)y) + 0.5f);
    path.flags = start.film.is_in_own_pixel ? NEARLIGHT_VERTEX_OWN_PIXEL : 0;
    return path;
}

static inline void set_receiver(const global CloseRange* close_range, const CameraPath* path,
                                const SurfaceHit* hit, const SurfaceBsdf* surface, float3 albedo,
                                uint surfaces, CameraReceiver* receiver) {
    receiver->position = off_surface(hit, hit->geometric);
    receiver->normal = surface->frame.n;
    receiver->surface = surface->bsdf.curve | surfaces << NEARLIGHT_RECEIVER_SURFACES_SHIFT |
                        sequence_index(path) << NEARLIGHT_RECEIVER_SAMPLE_SHIFT;
    receiver->sequence = path->sequence;
    receiver->mesh_normal = surface->mapped ? pack_mesh_normal(surface->unmapped) : 0;
    receiver->vertex.throughput = store3(path->ray.throughput);
    receiver->vertex.albedo = store3(albedo);
    receiver->vertex.flags |= in_close_range(close_range, hit->position) ? NEARLIGHT_VERTEX_CLOSE : 0;
}

/// Makes a receiver absent, whose light has been traced. Its normal, which it shows all the same, takes the
/// place of the mesh's; one of little weight has none.
static inline void leave_out(CameraReceiver* receiver) {
    const bool is_set = dot(receiver->normal, receiver->normal) > 0.0f;
    receiver->mesh_normal = is_set ? pack_mesh_normal(receiver->normal) : 0;
    receiver->normal = (float3)(0.0f);
}

/// What the surface at a step of a sample's path may ask of lights. A surface at which paths must end asks
/// none, but shows in the layers of surfaces.
static inline LightQuota quota_at(const CameraLimits* limits, uint step, uint sample) {
    const bool is_last = step + 1 >= limits->max_edges;
    const LightQuota quota = {is_last ? 0 : limits->light_samples, limits->light_rays,
                              is_last ? 0 : limits->max_edges - step - 2,
                              is_last || step > 0 ? 0 : limits->bundle_rays, sample * limits->light_samples};
    return quota;
}

/// Whether a depth limit leaves few edges to a receiver behind `step` mirrors and panes. VPLs would bring it
/// light mostly over paths that are too long, for rays to take away again. `min_weight` is above 0 where rays
/// bring light at all.
static inline bool has_few_edges(const CameraLimits* limits, uint step) {
    return step > 0 && limits->min_weight > 0.0f && limits->max_edges - step - 1 <= FEW_EDGES;
}

/// Finds the light of a receiver, whose D reflects `albedo`, by a ray of its own: as a receiver that asks
/// VPLs, one of little weight would cost as much as one that fills the pixel. At most `max_edges` edges are
/// left.
static inline void trace_light(const SceneView* scene, const CameraLimits* limits, const CameraPath* path,
                               const SurfaceHit* hit, const SurfaceBsdf* surface, float3 albedo,
                               uint max_edges, CameraVertex* vertex) {
    const ReceiverPoint at = receiver_of(off_surface(hit, hit->geometric), surface);
    const PathLimits ray = {.max_edges = max_edges,
                            .vpl_edges = max_edges,
                            .clamp_radius = INFINITY,
                            .light_samples = min(limits->light_samples, (uint)MAX_TRACED_LIGHT_SAMPLES),
                            .rays = 1,
                            .bundle_rays = 0,
                            .sample = sequence_index(path),
                            .shared_limit = INFINITY,
                            .aim = no_caustic_aim()};
    Finds finds = nothing_shared();
    const ReceivedLight light = received_light(
        scene, &at, &ray, random_uint4((uint4)(path->sequence, max_edges, 0x7ace5u, 0x3u)), &finds);
    const float3 response = path->ray.throughput * albedo * M_1_PI_F;
    vertex->traced_direct = store3(response * light.direct);
    vertex->traced_indirect = store3(response * light.indirect);
}

/// The surface that the path meets at a step. Branch 0 sets `first` to that of the first step, and branch 1
/// takes it from there.
static inline SurfaceHit trace_step(const SceneView* scene, const global Camera* camera,
                                    const CameraPath* path, uint step, uint branch, SurfaceHit* first) {
    if (step > 0) {
        return trace_surface(scene, path->ray.origin, path->ray.direction, INFINITY);
    }
    if (branch == 0) {
        const CameraRay ray = {path->ray.origin, path->ray.direction, path->t_min, path->t_max};
        *first = trace_first(scene, camera, &ray);
    }
    return *first;
}

/// Follows one branch to its receiver.
OUTLINED CameraReceiver follow_path(const SceneView* scene, const global Camera* camera,
                                    const global CloseRange* close_range, const CameraLimits* limits,
                                    CameraPath* path, uint branch, SurfaceHit* first) {
    CameraReceiver receiver = absent_receiver();
    receiver.vertex.filter_weight = path->filter_weight;
    receiver.vertex.film_x = path->film.x;
    receiver.vertex.film_y = path->film.y;
    const float3 straight = path->ray.direction;
    bool sees_sky = !camera->hides_emitters;
    for (uint step = 0; step < min(limits->max_edges, (uint)MAX_CHAIN); ++step) {
        const SurfaceHit hit = trace_step(scene, camera, path, step, branch, first);
        if (hit.t >= 0.0f || sees_sky) {
            path->camera_light += path->ray.throughput * met_light(scene, &path->ray, &hit);
        }
        if (hit.t < 0.0f) {
            break;
        }
        if (step == 0) {
            receiver.vertex.depth = hit.t;
            receiver.vertex.flags = path->flags;
        }
        const SurfaceNumbers numbers = surface_numbers(path, step);
        const SurfaceBsdf surface = surface_bsdf(scene, &hit, path->ray.direction, path->mode, numbers.model);
        float3 albedo;
        LightQuota quota = quota_at(limits, step, path->sample);
        const uint way = follow_surface(scene, path, &hit, &surface, branch, &quota, &numbers, &albedo);
        if (way == WAY_RECEIVER) {
            const bool is_weak = luminance(path->ray.throughput) < limits->min_weight;
            if (!is_weak) {
                set_receiver(close_range, path, &hit, &surface, albedo, step, &receiver);
                if (quota.bundle_rays > 0) {
                    receiver.seen = seen_surface(&hit, straight, numbers.model, quota.samples);
                }
            }
            if (is_weak || has_few_edges(limits, step)) {
                trace_light(scene, limits, path, &hit, &surface, albedo, limits->max_edges - step - 1,
                            &receiver.vertex);
                leave_out(&receiver);
            }
        }
        if (way != WAY_ON || !goes_on(path, step, numbers.end)) {
            break;
        }
        // A pane that does not turn the path hides no less than air does, as in Mitsuba.
        sees_sky = sees_sky || any(path->ray.direction != straight);
    }
    receiver.vertex.camera_light = store3(path->camera_light);
    return receiver;
}

/// Branch 1 of a path that never divides: it is where branch 0 is, but absent, and brings no light.
static inline CameraReceiver undivided_branch(CameraReceiver branch_0) {
    CameraReceiver receiver = branch_0;
    receiver.vertex.throughput = store3((float3)(0.0f));
    receiver.vertex.albedo = store3((float3)(0.0f));
    receiver.vertex.camera_light = store3((float3)(0.0f));
    receiver.vertex.traced_direct = receiver.vertex.traced_indirect = store3((float3)(0.0f));
    receiver.normal = (float3)(0.0f);
    receiver.seen.light_samples = 0;
    return receiver;
}

static inline void store_receiver(const CameraReceiver* from, global ReceiverPacket* to, uint lane,
                                  global CameraVertex* vertex) {
    to->px[lane] = from->position.x;
    to->py[lane] = from->position.y;
    to->pz[lane] = from->position.z;
    to->nx[lane] = from->normal.x;
    to->ny[lane] = from->normal.y;
    to->nz[lane] = from->normal.z;
    to->surface[lane] = from->surface;
    to->mesh_normal[lane] = from->mesh_normal;
    to->sequence[lane] = from->sequence;
    *vertex = from->vertex;
}

/// The pixel of the picture for a place of the launch, which has `width` places in a row. Beyond the end of a
/// list it is outside of every picture.
static inline uint2 launched_pixel(PixelList list, const global uint* pixels, uint width, uint2 place) {
    const uint number = place.y * width + place.x;
    if (list.count == 0) {
        return place;
    }
    if (number >= list.count) {
        return (uint2)(~0u);
    }
    const uint pixel = pixels[list.first + number];
    return (uint2)(list.x + pixel % list.width, list.y + pixel / list.width);
}

kernel void camera_pass(SCENE_PARAMETERS, const global Camera* restrict camera,
                        const global CloseRange* restrict close_range, const global uint* restrict pixels,
                        CameraPassParams params, global ReceiverPacket* restrict receivers,
                        global CameraVertex* restrict vertices, global SeenSurface* restrict seen) {
    const PacketOrder order = params.order;
    const uint index = (uint)get_global_id(0);
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    const uint sample = index / NEARLIGHT_PACKET_SIZE % order.sample_count;
    const uint tile = index / NEARLIGHT_PACKET_SIZE / order.sample_count;
    const uint column = tile % order.tile_columns;
    const uint row = tile / order.tile_columns;
    if (row >= params.tile_row_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const uint2 place =
        (uint2)(params.first_tile_column * NEARLIGHT_TILE_SIZE +
                    pixel_of_tile(column, lane % NEARLIGHT_TILE_SIZE, order.bundle_columns, order.interleave),
                params.first_tile_row * NEARLIGHT_TILE_SIZE +
                    pixel_of_tile(row, lane / NEARLIGHT_TILE_SIZE, order.bundle_rows, order.interleave));
    const uint2 at = launched_pixel(params.list, pixels, order.tile_columns * NEARLIGHT_TILE_SIZE, place);
    const bool in_picture = at.x < camera->width && at.y < camera->height;
    const CameraPath start = start_path(camera, at.x, at.y, params.first_sample + sample, params.in_middle,
                                        order.branch_count, params.seed);
    CameraReceiver receiver = absent_receiver();
    SurfaceHit first;
    bool divided = false;
    for (uint branch = 0; branch < order.branch_count; ++branch) {
        if (in_picture && (branch == 0 || divided)) {
            CameraPath path = start;
            path.sequence = sequence_key(at.y * camera->width + at.x, start.sample, branch, params.seed);
            receiver = follow_path(&scene, camera, close_range, &params.limits, &path, branch, &first);
            divided = !path.undivided;
        } else if (branch == 1) {
            receiver = undivided_branch(receiver);
        }
        const uint packet = packet_at(order, column, row, sample, branch);
        store_receiver(&receiver, receivers + packet, lane,
                       vertices + (size_t)packet * NEARLIGHT_PACKET_SIZE + lane);
        if (params.limits.bundle_rays > 0) {
            seen[(size_t)packet * NEARLIGHT_PACKET_SIZE + lane] = receiver.seen;
        }
    }
}
