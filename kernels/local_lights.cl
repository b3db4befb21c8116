// SPDX-License-Identifier: Apache-2.0
// Local lights [Davidovič et al., Combining Global and Local Virtual Lights for Detailed Glossy Illumination,
// SIGGRAPH Asia 2010]: each packet of 64 receivers x makes lights y of its own, which supply the light that a
// wide clamp takes from VPLs.
//
// The irradiance that is wanted is ∫ L_o(y) G_R V dy with G_r = cosθx·cosθy / max(d², r²), where d is the
// distance. Global VPLs at y are gathered with a radius R_g(y) ≥ R. The remainder, which is 0 from R_g on, is
//
//     ∫ L_o(y) (G_R − G_Rg) V dy  ≈  Σ_k  L_o(y_k) / p(y_k) · (G_R − G_Rg) V(x, y_k)
//     p(y) = Σ_s m · cosθs·cosθy / (π d²) · V(s, y) · [d < R_g(y)],
//
// with the sum Σ_s over all present receivers s of the packet.
//
// Each of these receivers sends m cosine-distributed rays, and a ray that meets a reflecting surface within
// R_g makes a light there. p is the density of all these rays together (probability-density summation: the
// balance heuristic over the receivers), so every receiver of the packet may use every light of it. The
// expectation of the sum is the integral wherever p > 0, and where (G_R − G_Rg) V > 0 for some x, the rays of
// x alone make p > 0. As p ≥ m·G_0/π, no term exceeds L_o·π/m. L_o is albedo·E/π. E is the direct light by
// next-event estimation plus the light of some global VPLs, which is bounded in turn. What that bound leaves
// out comes from the next short ray, and so on (lib/path_walk.cl), so light on its way to y is not bounded.
//
// R_g is a function of y (lib/path_walk.cl). Where much light falls, many VPLs lie, and they need no wide
// bound. With a wide bound, a small bright place, which few rays find, would make lights that are outliers.
//
// - local_light_radii: one work-item for each VPL computes R_g there.
// - local_light_rays: one work-item for each ray. Where it makes a light, slot (packet · m + ray) · 64 + lane
//   of `lights` gets it with the power albedo · E, that slot of `light_radii` gets R_g there, and that of
//   `flags` 1. Packets count from first_packet.
// - local_light_density: one work-item for each light listed in `indices` divides its power by p and writes
//   the receivers that see it as bits.
// - local_light_gather: one work-item for each receiver adds the lights of its packet to its irradiance.
// Any work-group size. Random numbers are keyed by the position of the packet's first present receiver, and
// no packet asks another, so no division of the picture changes the result.

#include "lib/path_walk.cl"
#include "lib/vpl.cl"

/// A receiver or a local light, as local_geometry() connects them.
typedef struct OrientedPoint {
    float3 position;  // off its surface
    float3 normal;
} OrientedPoint;

static inline OrientedPoint point_of_receiver(const global ReceiverPacket* packet, uint lane) {
    OrientedPoint point;
    point.position = receiver_position(packet, lane);
    point.normal = receiver_normal(packet, lane);
    return point;
}
static inline OrientedPoint point_of_light(const global Vpl* light) {
    OrientedPoint point;
    point.position = load3(light->position);
    point.normal = load3(light->normal);
    return point;
}

/// G_0 of a receiver and a light that is nearer than the radius, else 0. Points of one plane must not count.
/// Both stand off their triangles, by distances that differ by less than 0.3 of the ray epsilon there, unless
/// a triangle is very much larger than the radius.
static inline float local_geometry(const SceneView* scene, const OrientedPoint* receiver,
                                   const OrientedPoint* light, float radius) {
    const float3 to_receiver = receiver->position - light->position;
    const float squared = dot(to_receiver, to_receiver);
    const float height = dot(light->normal, to_receiver);
    const float cosine = -dot(receiver->normal, to_receiver);  // times the distance
    const bool open = squared < radius * radius && cosine > 0.0f &&
                      height > 0.3f * epsilon_about(scene, light->position, radius);
    return open ? height * cosine / (squared * squared) : 0.0f;
}

/// The key of a packet's random numbers: a hash of the position of its first present receiver.
static inline uint packet_key(const global ReceiverPacket* packet, uint seed) {
    uint lane = 0;
    while (lane + 1 < NEARLIGHT_PACKET_SIZE && packet->nx[lane] == 0.0f && packet->ny[lane] == 0.0f &&
           packet->nz[lane] == 0.0f) {
        ++lane;
    }
    return random_uint4(
               (uint4)(as_uint(packet->px[lane]), as_uint(packet->py[lane]), as_uint(packet->pz[lane]), seed))
        .x;
}

kernel void local_light_radii(SCENE_PARAMETERS, const global Vpl* restrict vpls, uint vpl_count,
                              GatherRadius law, global float* restrict radii) {
    const uint index = (uint)get_global_id(0);
    if (index >= vpl_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    radii[index] = gather_radius(&scene, &law, load3(vpls[index].position), load3(vpls[index].normal));
}

kernel void local_light_rays(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers,
                             LocalLightParams params, const global Vpl* restrict vpls,
                             const global float* restrict vpl_radii, global Vpl* restrict lights,
                             global float* restrict light_radii, global uint* restrict flags) {
    const uint slot = (uint)get_global_id(0);
    if (slot >= params.slot_count) {
        return;
    }
    flags[slot] = 0;
    const SceneView scene = SCENE_VIEW;
    const uint slots_per_packet = params.rays_per_receiver * NEARLIGHT_PACKET_SIZE;
    const global ReceiverPacket* packet = receivers + params.first_packet + slot / slots_per_packet;
    const OrientedPoint receiver = point_of_receiver(packet, slot % NEARLIGHT_PACKET_SIZE);
    if (!(dot(receiver.normal, receiver.normal) > 0.0f)) {
        return;
    }
    const uint key = packet_key(packet, params.law.seed);
    const uint index = slot % slots_per_packet;
    const float3 direction =
        to_world_frame(square_to_cosine_hemisphere(sample_2d(index, 0, key)), receiver.normal);
    const float reach = params.law.max_radius + 2.0f * ray_epsilon(receiver.position, scene.info->extent);
    const SurfaceHit hit = trace_surface(&scene, receiver.position, direction, reach);
    if (hit.t < 0.0f) {
        return;
    }
    const SurfaceBsdf surface =
        surface_bsdf(&scene, &hit, direction, BSDF_RADIANCE, sample_2d(index, 1, key).x);
    OrientedPoint light;
    light.position = off_surface(&hit, hit.geometric);
    light.normal = hit.geometric;
    const float3 albedo = surface.bsdf.diffuse;
    const float radius = gather_radius(&scene, &params.law, light.position, light.normal);
    if (is_black(albedo) || !(local_geometry(&scene, &receiver, &light, radius) > 0.0f)) {
        return;
    }
    const uint walk_key = random_uint4((uint4)(index, key, 0x10ca1u, 1u)).x;
    const Connections to = {vpls, vpl_radii, params.vpl_count, params.connections, params.law};
    const ReceiverPoint at = receiver_of(light.position, &surface);
    const float3 exitance = albedo * short_walk_irradiance(&scene, &to, &at, params.bounce_count,
                                                           params.direct_samples, walk_key);
    if (is_black(exitance)) {
        return;
    }
    lights[slot] = make_vpl(light.position, light.normal, surface.frame.n, surface.bsdf.curve, 0,
                            mapped_flag(&surface), exitance);
    light_radii[slot] = radius;
    flags[slot] = 1;
}

kernel void local_light_density(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers,
                                uint first_packet, uint rays_per_receiver,
                                const global float* restrict light_radii, const global uint* restrict indices,
                                uint light_count, global Vpl* restrict lights,
                                global ulong* restrict seen_by) {
    const uint item = (uint)get_global_id(0);
    if (item >= light_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const uint slot = indices[item];
    const global ReceiverPacket* packet =
        receivers + first_packet + slot / (rays_per_receiver * NEARLIGHT_PACKET_SIZE);
    const OrientedPoint light = point_of_light(lights + slot);
    const float3 seen = seen_normal(lights + slot);
    const float radius = light_radii[slot];
    float sum = 0.0f;
    ulong mask = 0;
    for (uint lane = 0; lane < NEARLIGHT_PACKET_SIZE; ++lane) {
        const OrientedPoint receiver = point_of_receiver(packet, lane);
        const float geometry = local_geometry(&scene, &receiver, &light, radius);
        // A ray that meets the surface behind its shading normal makes no light.
        const bool is_seen = dot(seen, receiver.position - light.position) > 0.0f;
        if (geometry > 0.0f && is_seen && is_visible(&scene, light.position, receiver.position)) {
            sum += geometry;
            mask |= (ulong)1 << lane;
        }
    }
    const float density = (float)rays_per_receiver * sum * M_1_PI_F;
    lights[slot].power = store3(mask != 0 ? load3(lights[slot].power) / density : (float3)(0.0f));
    seen_by[slot] = mask;
}

kernel void local_light_gather(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers,
                               uint first_packet, uint lane_count, uint rays_per_receiver, float clamp_radius,
                               const global Vpl* restrict lights, const global float* restrict light_radii,
                               const global uint* restrict flags, const global ulong* restrict seen_by,
                               global IrradiancePacket* restrict irradiance) {
    const uint index = (uint)get_global_id(0);
    if (index >= lane_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    const uint slots_per_packet = rays_per_receiver * NEARLIGHT_PACKET_SIZE;
    const uint first_slot = index / NEARLIGHT_PACKET_SIZE * slots_per_packet;
    const uint packet = first_packet + index / NEARLIGHT_PACKET_SIZE;
    const OrientedPoint receiver = point_of_receiver(receivers + packet, lane);
    const float3 mesh_normal = receiver_mesh_normal(receivers + packet, lane);
    const uint curve = receiver_curve(receivers + packet, lane);
    float3 sum = (float3)(0.0f);
    for (uint slot = first_slot; slot < first_slot + slots_per_packet; ++slot) {
        if (flags[slot] == 0 || (seen_by[slot] >> lane & 1) == 0) {
            continue;
        }
        const OrientedPoint light = point_of_light(lights + slot);
        const float3 between = receiver.position - light.position;
        const float squared = dot(between, between);
        const float radius = light_radii[slot];
        // This is (G_R − G_Rg) / G_0, for a distance below R_g.
        const float bounded = clamp_radius * clamp_radius;
        const float part = (squared < bounded ? squared / bounded : 1.0f) - squared / (radius * radius);
        const float inverse = rsqrt(squared);
        const float cos_seen = dot(seen_normal(lights + slot), between) * inverse;
        const float transmission =
            diffuse_transmission(&scene, vpl_curve(lights + slot), cos_seen) *
            diffuse_transmission(&scene, curve, -dot(receiver.normal, between) * inverse);
        const float unshadowed = unshadowed_part(receiver.normal, mesh_normal, -between * inverse);
        const float geometry = local_geometry(&scene, &receiver, &light, radius);
        sum += load3(lights[slot].power) * (M_1_PI_F * part * transmission * unshadowed * geometry);
    }
    add_irradiance_to(irradiance + packet, lane, sum);
}
