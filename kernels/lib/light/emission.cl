// SPDX-License-Identifier: Apache-2.0
// Particles that leave lights, for walks.
#ifndef NEARLIGHT_LIB_LIGHT_EMISSION
#define NEARLIGHT_LIB_LIGHT_EMISSION

#include "lib/light/choice.cl"
#include "lib/light/delta.cl"
#include "lib/light/environment.cl"
#include "lib/light/triangle.cl"

/// A particle that leaves a light.
typedef struct EmittedParticle {
    float3 origin;
    float3 direction;
    float3 flux;      // W, divided by the density with which the particle was chosen
    uint from_delta;  // 1: from a light that no path can hit
} EmittedParticle;

inline EmittedParticle emit_from_triangle(const SceneView* scene, const global Emitter* emitter,
                                          float2 u_position, float2 u_direction) {
    EmittedParticle particle;
    float3 normal;
    const float2 place = square_to_triangle(u_position);
    const float3 point = triangle_point(scene, emitter->triangle, place, &normal);
    particle.origin = offset_point(scene, point, normal);
    particle.direction = to_world_frame(square_to_cosine_hemisphere(u_direction), normal);
    particle.flux = triangle_radiance(scene, emitter->triangle, place) * (M_PI_F * emitter->area);
    particle.from_delta = 0;
    return particle;
}

/// A particle of a uniform point of a sphere or cylinder, which starts where it leaves the last of the
/// light's triangles behind.
inline EmittedParticle emit_from_round_light(const SceneView* scene, const global Emitter* emitter,
                                             float2 u_position, float2 u_direction) {
    const bool is_sphere = emitter->type == NEARLIGHT_EMITTER_SPHERE;
    const float3 axis = load3(emitter->direction);
    const float3 normal = is_sphere ? square_to_cone(u_position, -1.0f)
                                    : to_world_frame((float3)(circle_point(u_position.y), 0.0f), axis);
    const float3 center =
        load3(emitter->position) + (is_sphere ? (float3)(0.0f) : u_position.x * emitter->length * axis);
    EmittedParticle particle;
    particle.direction = to_world_frame(square_to_cosine_hemisphere(u_direction), normal);
    const float radius = emitter->radius;
    const float outer = emitter->outer_radius;
    const float along = is_sphere ? 0.0f : dot(particle.direction, axis);
    const float rise = radius * dot(normal, particle.direction);
    const float gap = (outer - radius) * (outer + radius);
    const float way = gap / fmax(rise + sqrt(rise * rise + (1.0f - along * along) * gap), 1e-30f);
    const float3 exit = radius * normal + way * particle.direction;
    const float3 outwards = (exit - way * along * axis) / outer;
    particle.origin = offset_point(scene, center + exit, outwards);
    particle.flux = load3(emitter->radiance) * (M_PI_F * emitter->area);
    particle.from_delta = 0;
    return particle;
}

/// Where light that travels along −`from` enters the scene: a point on a disk of the scene's size that faces
/// the light.
inline float3 entry_point(const SceneView* scene, float3 from, float2 u) {
    const float radius = scene->environment->scene_radius;
    return load3(scene->environment->scene_center) + radius * from +
           to_world_frame((float3)(radius * sqrt(u.x) * circle_point(u.y), 0.0f), from);
}

inline float entry_area(const SceneView* scene) {
    return M_PI_F * scene->environment->scene_radius * scene->environment->scene_radius;
}

inline EmittedParticle emit_from_environment(const SceneView* scene, bool is_sun, float2 u_position,
                                             float2 u_direction) {
    float3 from;
    float3 radiance;
    float pdf;
    if (is_sun) {
        from = sample_sun(scene, u_direction);
        radiance = load3(scene->environment->sun_radiance);
        pdf = 1.0f / (2.0f * M_PI_F * scene->environment->sun_height);
    } else {
        const MapSample map = sample_map(scene, u_direction);
        from = map.direction;
        radiance = map_radiance(scene, map.place);
        pdf = map.pdf;
    }
    EmittedParticle particle;
    particle.origin = entry_point(scene, from, u_position);
    particle.direction = -from;
    particle.flux = pdf > 0.0f ? radiance * (entry_area(scene) / pdf) : (float3)(0.0f);
    particle.from_delta = 0;
    return particle;
}

inline EmittedParticle emit_from_point(const SceneView* scene, const global Emitter* emitter,
                                       float2 u_direction) {
    const bool is_spot = emitter->type == NEARLIGHT_EMITTER_SPOT;
    const float cos_max = is_spot ? cos(emitter->cutoff_angle) : -1.0f;
    const float3 axis = is_spot ? load3(emitter->direction) : (float3)(0.0f, 0.0f, 1.0f);
    EmittedParticle particle;
    particle.origin = load3(emitter->position);
    particle.direction = to_world_frame(square_to_cone(u_direction, cos_max), axis);
    particle.flux = delta_intensity(scene, emitter, particle.direction) * (2.0f * M_PI_F * (1.0f - cos_max));
    particle.from_delta = 1;
    return particle;
}

/// A particle through a uniform point of the image plane at the distance 1, on which dω = cos³ dA.
inline EmittedParticle emit_from_projector(const SceneView* scene, const global Emitter* emitter, float2 st) {
    const float3 x_axis = load3(emitter->x_axis);
    const float3 y_axis = load3(emitter->y_axis);
    EmittedParticle particle;
    particle.origin = load3(emitter->position);
    particle.direction =
        normalize(load3(emitter->direction) + x_axis * ((st.x - 0.5f) / dot(x_axis, x_axis)) +
                  y_axis * ((st.y - 0.5f) / dot(y_axis, y_axis)));
    particle.flux = load3(emitter->radiance) * image_color(scene, emitter, st) * emitter->area;
    particle.from_delta = 1;
    return particle;
}

inline EmittedParticle emit_from_direction(const SceneView* scene, const global Emitter* emitter,
                                           float2 u_position) {
    EmittedParticle particle;
    particle.direction = load3(emitter->direction);
    particle.origin = entry_point(scene, -particle.direction, u_position);
    particle.flux = load3(emitter->radiance) * entry_area(scene);
    particle.from_delta = 1;
    return particle;
}

inline EmittedParticle emit_particle(const SceneView* scene, float2 choice, float2 u_position,
                                     float2 u_direction) {
    const global Emitter* emitter = scene->emitters + choose_emitter(scene, choice.x);
    EmittedParticle particle;
    if (emitter->type == NEARLIGHT_EMITTER_TRIANGLE) {
        particle = emit_from_triangle(scene, emitter, u_position, u_direction);
    } else if (is_area_light(emitter)) {
        particle = emit_from_round_light(scene, emitter, u_position, u_direction);
    } else if (emitter->type == NEARLIGHT_EMITTER_ENVIRONMENT || emitter->type == NEARLIGHT_EMITTER_SUN) {
        particle =
            emit_from_environment(scene, emitter->type == NEARLIGHT_EMITTER_SUN, u_position, u_direction);
    } else if (emitter->type == NEARLIGHT_EMITTER_DIRECTIONAL) {
        particle = emit_from_direction(scene, emitter, u_position);
    } else if (emitter->type == NEARLIGHT_EMITTER_PROJECTOR) {
        particle = emit_from_projector(scene, emitter, u_direction);
    } else {
        particle = emit_from_point(scene, emitter, u_direction);
    }
    particle.flux /= emitter->probability;
    return particle;
}

#endif
