// SPDX-License-Identifier: Apache-2.0
// Particles that leave lights, for walks.
#ifndef NEARLIGHT_LIB_LIGHT_EMISSION
#define NEARLIGHT_LIB_LIGHT_EMISSION

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

static inline EmittedParticle emit_from_triangle(const SceneView* scene, const global Emitter* emitter,
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
static inline EmittedParticle emit_from_round_light(const SceneView* scene, const global Emitter* emitter,
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

/// A third each of the walks from infinitely far away enter across the shadow of the sphere at which they
/// aim, around this shadow, and across the whole scene. Walks on far surfaces go on in the same parts
/// (lib/aim_cone.cl).
#define PART_AIMED (1.0f / 3.0f)
#define PART_AROUND (1.0f / 3.0f)
#define PART_SPREAD (1.0f - PART_AIMED - PART_AROUND)

/// Where light from infinitely far away enters the scene.
typedef struct EntryPoint {
    float3 position;
    float area;  // 1 over the density across the light, m²
} EntryPoint;

/// An entry point on the disk of the scene's size that faces the light.
static inline EntryPoint spread_entry(float3 center, float radius, float3 from, float2 u) {
    EntryPoint entry;
    entry.position =
        center + radius * from + to_world_frame((float3)(radius * sqrt(u.x) * circle_point(u.y), 0.0f), from);
    entry.area = M_PI_F * radius * radius;
    return entry;
}

/// The place across light that travels along −`from`, from the middle of the sphere's shadow, of a walk that
/// aims (u.x < PART_AIMED) or lands around (u.x < PART_AIMED + PART_AROUND). Around the shadow, each doubling
/// of the distance up to radius · e^`log_reach` gets as many walks.
static inline float3 place_about(float radius, float log_reach, float3 from, float2 u) {
    const float distance = u.x < PART_AIMED ? radius * sqrt(u.x / PART_AIMED)
                                            : radius * exp(log_reach * (u.x - PART_AIMED) / PART_AROUND);
    return to_world_frame((float3)(distance * circle_point(u.y), 0.0f), from);
}

/// An entry point of light that travels along −`from`. The density is that of all three ways together, so
/// that no walk counts for much only because it came by an unlikely way. Where the sphere at which walks aim
/// is about as large as the scene, there is nothing to win, and all are spread.
static inline EntryPoint entry_point(const SceneView* scene, WalkAim aim, float3 from, float2 u) {
    const float3 center = load3(scene->environment->scene_center);
    const float radius = scene->environment->scene_radius;
    if (!(aim.radius > 0.0f && aim.radius < 0.5f * radius)) {
        return spread_entry(center, radius, from, u);
    }
    const float3 to_aim = load3(aim.center) - center;
    const float3 shadow = to_aim - dot(to_aim, from) * from;
    const float log_reach = log((radius + length(shadow)) / aim.radius);
    EntryPoint entry;
    if (u.x < PART_AIMED + PART_AROUND) {
        entry.position = center + radius * from + shadow + place_about(aim.radius, log_reach, from, u);
    } else {
        const float2 v = (float2)((u.x - PART_AIMED - PART_AROUND) / PART_SPREAD, u.y);
        entry.position = spread_entry(center, radius, from, v).position;
    }
    const float3 place = entry.position - center - radius * from;
    const float3 off = place - shadow;
    const float squared = dot(off, off);
    const float spread = dot(place, place) < radius * radius ? PART_SPREAD / (radius * radius) : 0.0f;
    const float about = squared < aim.radius * aim.radius ? PART_AIMED / (aim.radius * aim.radius)
                                                          : PART_AROUND / (2.0f * squared * log_reach);
    entry.area = M_PI_F / (spread + about);
    return entry;
}

static inline EmittedParticle emit_from_environment(const SceneView* scene, WalkAim aim, bool is_sun,
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

static inline EmittedParticle emit_from_direction(const SceneView* scene, WalkAim aim,
                                                  const global Emitter* emitter, float2 u_position) {
    EmittedParticle particle;
    particle.direction = load3(emitter->direction);
    const EntryPoint entry = entry_point(scene, aim, -particle.direction, u_position);
    particle.origin = entry.position;
    particle.flux = load3(emitter->radiance) * entry.area;
    particle.from_delta = 1;
    return particle;
}

OUTLINED EmittedParticle emit_particle(const SceneView* scene, WalkAim aim, float2 choice, float2 u_position,
                                       float2 u_direction) {
    const global Emitter* emitter = scene->emitters + choose_emitter(scene, choice.x);
    EmittedParticle particle;
    if (emitter->type == NEARLIGHT_EMITTER_TRIANGLE) {
        particle = emit_from_triangle(scene, emitter, u_position, u_direction);
    } else if (is_area_light(emitter)) {
        particle = emit_from_round_light(scene, emitter, u_position, u_direction);
    } else if (emitter->type == NEARLIGHT_EMITTER_ENVIRONMENT || emitter->type == NEARLIGHT_EMITTER_SUN) {
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
