// SPDX-License-Identifier: Apache-2.0
// Particles that leave lights, for walks.
#ifndef NEARLIGHT_LIB_LIGHT_EMISSION
#define NEARLIGHT_LIB_LIGHT_EMISSION

#include "lib/aim_cone.cl"
#include "lib/light/choice.cl"
#include "lib/light/delta.cl"
#include "lib/light/environment.cl"
#include "lib/light/triangle.cl"
#include "lib/outlined.cl"

/// A particle that leaves a light.
typedef struct EmittedParticle {
    float3 origin;
    float3 direction;
    float3 flux;      // W, divided by the density with which the particle was chosen
    uint from_delta;  // 1: from a light that no path can hit
} EmittedParticle;

/// A direction in which light leaves a point of a surface that emits the same radiance in all directions.
typedef struct EmittedDirection {
    float3 direction;
    float solid_angle;  // the cosine over the density of the direction, sr
} EmittedDirection;

/// A direction from x, on a surface with this normal: by the cosine, or about one of the targets that are far
/// from x, such as a room in the middle of a dome that lights it. The density is that of all ways together
/// (the balance heuristic).
static inline EmittedDirection sample_emitted_direction(const WalkAim* aim, float3 x, float3 normal,
                                                        float2 u) {
    const AimParts parts = divide_aim(aim, targets_for_surface(aim, x, normal));
    float number = u.x;
    const uint chosen = choose_aim_target(&parts, aim_target_count(aim), &number);
    EmittedDirection emitted;
    if (chosen == NO_AIM_TARGET) {
        emitted.direction = to_world_frame(square_to_cosine_hemisphere((float2)(number, u.y)), normal);
    } else {
        const AimTarget target = aim_target(aim, chosen);
        const AimCone cone = aim_cone(&target, x);
        const bool towards = goes_towards(&number);
        emitted.direction = aim_cone_sample(&cone, towards, (float2)(number, u.y));
    }
    if (parts.sum == 0.0f) {
        emitted.solid_angle = M_PI_F;
        return emitted;
    }
    const float cosine = fmax(dot(emitted.direction, normal), 0.0f);
    const float pdf = (1.0f - parts.sum) * cosine * M_1_PI_F + aim_pdf(aim, &parts, x, emitted.direction);
    emitted.solid_angle = cosine > 0.0f ? cosine / pdf : 0.0f;
    return emitted;
}

static inline EmittedParticle emit_from_triangle(const SceneView* scene, const WalkAim* aim,
                                                 const global Emitter* emitter, float2 u_position,
                                                 float2 u_direction) {
    EmittedParticle particle;
    float3 normal;
    const float2 place = square_to_triangle(u_position);
    const float3 point = triangle_point(scene, emitter->triangle, place, &normal);
    const EmittedDirection emitted = sample_emitted_direction(aim, point, normal, u_direction);
    particle.origin = point + triangle_stand_off(scene, emitter->triangle) * normal;
    particle.direction = emitted.direction;
    particle.flux =
        triangle_radiance(scene, emitter->triangle, place) * (emitted.solid_angle * emitter->area);
    particle.from_delta = 0;
    return particle;
}

/// A particle of a uniform point of a sphere or cylinder, which starts where it leaves the last of the
/// light's triangles behind.
static inline EmittedParticle emit_from_round_light(const SceneView* scene, const WalkAim* aim,
                                                    const global Emitter* emitter, float2 u_position,
                                                    float2 u_direction) {
    const bool is_sphere = emitter->type == NEARLIGHT_EMITTER_SPHERE;
    const float3 axis = load3(emitter->direction);
    const float3 normal = is_sphere ? square_to_cap(u_position, 2.0f)
                                    : to_world_frame((float3)(circle_point(u_position.y), 0.0f), axis);
    const float3 center =
        load3(emitter->position) + (is_sphere ? (float3)(0.0f) : u_position.x * emitter->length * axis);
    const float radius = emitter->radius;
    const EmittedDirection emitted =
        sample_emitted_direction(aim, center + radius * normal, normal, u_direction);
    EmittedParticle particle;
    particle.direction = emitted.direction;
    const float outer = emitter->outer_radius;
    const float along = is_sphere ? 0.0f : dot(particle.direction, axis);
    const float rise = radius * dot(normal, particle.direction);
    const float gap = (outer - radius) * (outer + radius);
    const float way = gap / fmax(rise + sqrt(rise * rise + (1.0f - along * along) * gap), 1e-30f);
    const float3 exit = radius * normal + way * particle.direction;
    const float3 outwards = (exit - way * along * axis) / outer;
    particle.origin = off_round_light(scene, emitter, center + exit, outwards);
    particle.flux = load3(emitter->radiance) * (emitted.solid_angle * emitter->area);
    particle.from_delta = 0;
    return particle;
}

/// Where light from infinitely far away enters the scene.
typedef struct EntryPoint {
    float3 position;
    float area;  // 1 over the density across the light, m²
} EntryPoint;

/// A place on the disc of the given radius that lies across light which travels along −`from`, from its
/// middle.
static inline float3 place_on_disk(float radius, float3 from, float2 u) {
    return to_world_frame((float3)(radius * sqrt(u.x) * circle_point(u.y), 0.0f), from);
}

/// The shadow of a target across light that travels along −`from`. Places there are vectors from the middle
/// of the scene that are perpendicular to `from`.
typedef struct AimShadow {
    float3 middle;
    // Squares of the distances from the middle between which walks pass around it, m².
    float min_squared, max_squared;
} AimShadow;

static inline AimShadow aim_shadow(const SceneView* scene, const AimTarget* target, float3 from) {
    const float3 to_target = target->center - load3(scene->environment->scene_center);
    AimShadow shadow;
    shadow.middle = to_target - dot(to_target, from) * from;
    const float reach = scene->environment->scene_radius + length(shadow.middle);
    shadow.min_squared = target->radius * target->radius;
    shadow.max_squared = reach * reach;
    return shadow;
}

/// The place of a walk that aims at the target: within its shadow, or around it.
static inline float3 place_about(const AimShadow* shadow, float3 from, float2 u) {
    float number = u.x;
    const bool towards = goes_towards(&number);
    const float squared = towards ? shadow->min_squared * number
                                  : cover_around(shadow->min_squared, shadow->max_squared, number);
    return shadow->middle + to_world_frame((float3)(sqrt(squared) * circle_point(u.y), 0.0f), from);
}

/// The density of such places, times π (1/m²).
static inline float density_about(const AimShadow* shadow, float3 place) {
    const float3 off = place - shadow->middle;
    const float squared = dot(off, off);
    return squared < shadow->min_squared
               ? PART_TOWARDS / shadow->min_squared
               : (1.0f - PART_TOWARDS) * density_around(shadow->min_squared, shadow->max_squared, squared);
}

/// The targets that are of use to light that travels along −`from`: the sphere, unless it is about as large
/// as the scene, and the openings through which such light comes in.
static inline uint targets_for_light(const SceneView* scene, const WalkAim* aim, float3 from) {
    const bool is_small = aim->radius > 0.0f && aim->radius < 0.5f * scene->environment->scene_radius;
    uint useful = is_small ? 1 : 0;
    for (uint i = 0; i < aim->opening_count; ++i) {
        useful |= dot(load3(aim->openings[i].outwards), from) > 0.0f ? 2u << i : 0u;
    }
    return useful;
}

/// An entry point of light that travels along −`from`: about one of the targets, or on the disc of the
/// scene's size that faces the light.
static inline EntryPoint entry_point(const SceneView* scene, const WalkAim* aim, float3 from, float2 u) {
    const float radius = scene->environment->scene_radius;
    const AimParts parts = divide_aim(aim, targets_for_light(scene, aim, from));
    const uint count = aim_target_count(aim);
    float number = u.x;
    const uint chosen = choose_aim_target(&parts, count, &number);
    const float2 v = (float2)(number, u.y);
    float3 place;
    if (chosen == NO_AIM_TARGET) {
        place = place_on_disk(radius, from, v);
    } else {
        const AimTarget target = aim_target(aim, chosen);
        const AimShadow shadow = aim_shadow(scene, &target, from);
        place = place_about(&shadow, from, v);
    }
    const bool is_on_disk = chosen == NO_AIM_TARGET || dot(place, place) < radius * radius;
    float density = is_on_disk ? (1.0f - parts.sum) / (radius * radius) : 0.0f;
    for (uint i = 0; i < count; ++i) {
        if (parts.of[i] > 0.0f) {
            const AimTarget target = aim_target(aim, i);
            const AimShadow shadow = aim_shadow(scene, &target, from);
            density += parts.of[i] * density_about(&shadow, place);
        }
    }
    EntryPoint entry;
    entry.position = load3(scene->environment->scene_center) + radius * from + place;
    entry.area = M_PI_F / density;
    return entry;
}

static inline EmittedParticle emit_from_environment(const SceneView* scene, const WalkAim* aim, bool is_sun,
                                                    float2 u_position, float2 u_direction) {
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
    const EntryPoint entry = entry_point(scene, aim, from, u_position);
    EmittedParticle particle;
    particle.origin = entry.position;
    particle.direction = -from;
    particle.flux = pdf > 0.0f ? radiance * (entry.area / pdf) : (float3)(0.0f);
    particle.from_delta = 0;
    return particle;
}

static inline EmittedParticle emit_from_point(const SceneView* scene, const global Emitter* emitter,
                                              float2 u_direction) {
    const bool is_spot = emitter->type == NEARLIGHT_EMITTER_SPOT;
    const float half_chord = is_spot ? sin(0.5f * emitter->cutoff_angle) : 1.0f;
    const float height = 2.0f * half_chord * half_chord;
    const float3 axis = is_spot ? load3(emitter->direction) : (float3)(0.0f, 0.0f, 1.0f);
    EmittedParticle particle;
    particle.origin = load3(emitter->position);
    particle.direction = to_world_frame(square_to_cap(u_direction, height), axis);
    particle.flux = delta_intensity(scene, emitter, particle.direction) * (2.0f * M_PI_F * height);
    particle.from_delta = 1;
    return particle;
}

/// A particle through a uniform point of the image plane at the distance 1, on which dω = cos³ dA.
static inline EmittedParticle emit_from_projector(const SceneView* scene, const global Emitter* emitter,
                                                  float2 st) {
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

static inline EmittedParticle emit_from_direction(const SceneView* scene, const WalkAim* aim,
                                                  const global Emitter* emitter, float2 u_position) {
    EmittedParticle particle;
    particle.direction = load3(emitter->direction);
    const EntryPoint entry = entry_point(scene, aim, -particle.direction, u_position);
    particle.origin = entry.position;
    particle.flux = load3(emitter->radiance) * entry.area;
    particle.from_delta = 1;
    return particle;
}

/// A particle of the light that `choice` picks. All numbers are independent and uniform in [0, 1).
OUTLINED EmittedParticle emit_particle(const SceneView* scene, const WalkAim* aim, float choice,
                                       float2 u_position, float2 u_direction) {
    const global Emitter* emitter = scene->emitters + choose_emitter(scene, choice);
    EmittedParticle particle;
    if (emitter->type == NEARLIGHT_EMITTER_TRIANGLE) {
        particle = emit_from_triangle(scene, aim, emitter, u_position, u_direction);
    } else if (is_area_light(emitter)) {
        particle = emit_from_round_light(scene, aim, emitter, u_position, u_direction);
    } else if (is_distant(emitter)) {
        particle = emit_from_environment(scene, aim, emitter->type == NEARLIGHT_EMITTER_SUN, u_position,
                                         u_direction);
    } else if (emitter->type == NEARLIGHT_EMITTER_DIRECTIONAL) {
        particle = emit_from_direction(scene, aim, emitter, u_position);
    } else if (emitter->type == NEARLIGHT_EMITTER_PROJECTOR) {
        particle = emit_from_projector(scene, emitter, u_direction);
    } else {
        particle = emit_from_point(scene, emitter, u_direction);
    }
    particle.flux /= emitter->probability;
    return particle;
}

#endif
