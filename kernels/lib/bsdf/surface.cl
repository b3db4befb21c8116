// SPDX-License-Identifier: Apache-2.0
// The BSDF of a point that a ray met: textures looked up, and models that stand for others resolved.
//
// Which side of a surface the viewer is on follows from the shading normal alone, as in Mitsuba's path
// integrator, and so does on which side of it light arrives. The geometric normal decides where rays start: a
// ray along wi starts on the side of the triangle that wi points to. For flux it also counts in
// transport_factor().
#ifndef NEARLIGHT_LIB_BSDF_SURFACE
#define NEARLIGHT_LIB_BSDF_SURFACE

#include "lib/bsdf/bsdf_types.cl"
#include "lib/map_shadowing.cl"
#include "lib/texture.cl"

// What a path carries. Both kinds of path find the same light (Veach 1997, §5.2 and §5.3).
#define BSDF_RADIANCE 0u  // it comes from the camera; wo points back along it, wi towards the light
#define BSDF_FLUX 1u      // it comes from a light; wo points back to it, wi onwards
#define BSDF_CAMERA 2u    // as radiance, and nothing but mirrors and glass is between the camera and here

typedef struct SurfaceBsdf {
    Bsdf bsdf;
    Frame frame;          // shading frame in world space, n on the viewer's side; either handedness
    float3 geometric;     // normal of the triangle on the side that the ray came from
    float3 wo;            // unit vector back along the ray
    uint mode;            // BSDF_RADIANCE, BSDF_FLUX or BSDF_CAMERA
    uint unscaled;        // 1: radiance does not change with the index of what it is in, as under clear glass
    float s_probability;  // probability of S where D and S are sampled together
    uint mapped;          // 0: the frame's n is the mesh's own; otherwise MAPPED or MAPPED_TURNED
    float3 unmapped;      // the frame's n before the map
    float tilt2;          // of the map: the squared α of its shadowing
    float scale;          // 1 ÷ probability of what was chosen at the map
} SurfaceBsdf;

#define MAPPED 1u
#define MAPPED_TURNED 2u  // the mapped normal is turned about the mesh's, as it would face away otherwise

/// Derivatives of the position by u and v; the edges of the triangle where its (u, v) lie on one line.
static inline void position_derivatives(const SceneView* scene, const SurfaceHit* hit, float3* du,
                                        float3* dv) {
    const Triangle triangle = scene->triangles[hit->triangle];
    const global Vertex* a = scene->vertices + triangle.v0;
    const global Vertex* b = scene->vertices + triangle.v1;
    const global Vertex* c = scene->vertices + triangle.v2;
    const float3 edge1 = load3(b->position) - load3(a->position);
    const float3 edge2 = load3(c->position) - load3(a->position);
    const float2 uv1 = (float2)(b->u - a->u, b->v - a->v);
    const float2 uv2 = (float2)(c->u - a->u, c->v - a->v);
    const float determinant = uv1.x * uv2.y - uv1.y * uv2.x;
    if (determinant == 0.0f) {
        *du = edge1;
        *dv = edge2;
        return;
    }
    *du = (uv2.y * edge1 - uv1.y * edge2) / determinant;
    *dv = (uv1.x * edge2 - uv2.x * edge1) / determinant;
}

/// A frame about n whose tangent is as near to `along` as can be.
static inline Frame frame_along(float3 n, float3 along) {
    const float3 tangent = along - dot(n, along) * n;
    const float squared = dot(tangent, tangent);
    if (!(squared > 0.0f)) {
        return make_frame(n);
    }
    Frame frame;
    frame.tangent = tangent * rsqrt(squared);
    frame.bitangent = cross(n, frame.tangent);
    frame.n = n;
    return frame;
}

/// The normal of the displaced surface in the frame of the surface, where the position has the derivatives du
/// and dv, and the displacement the gradient. [Blinn 1978; Mitsuba's `bumpmap`]
static inline float3 bumped_normal(const SurfaceHit* hit, const Frame* front, float3 du, float3 dv,
                                   float2 gradient) {
    du += (gradient.x - dot(front->n, du)) * front->n;
    dv += (gradient.y - dot(front->n, dv)) * front->n;
    const float3 n = cross(du, dv);
    const float squared = dot(n, n);
    if (!(squared > 0.0f)) {
        return (float3)(0.0f, 0.0f, 1.0f);
    }
    const float3 geometric = hit->front ? hit->geometric : -hit->geometric;
    return world_to_frame(front, n * (rsqrt(squared) * (dot(n, geometric) < 0.0f ? -1.0f : 1.0f)));
}

/// Decides with this probability. `u`, which is uniform in [0, 1), is so again afterwards, whatever was
/// decided.
static inline bool decide(float* u, float probability) {
    const bool yes = *u < probability;
    // Rounding may take the quotient to 1, at which a later decision with probability 1 would say no.
    *u = fmin(yes ? *u / probability : (*u - probability) / (1.0f - probability), 0x1.fffffep-1f);
    return yes;
}

/// The probability with which a path of flux turns the normal of a map that the light sees from the front.
#define TURNING_PROBABILITY 0.125f

/// Tilts the frame to the normal n, which is given in the frame itself and need not have unit length; one
/// without a direction leaves the frame as it is. As in Mitsuba, a normal that the viewer sees from behind is
/// turned about the frame's. Which viewers a path of flux will find is not known yet, so some such
/// paths turn the normal, by `u`, and count only for viewers for whom it is turned. Maps on one another
/// decide together.
static inline void tilt_frame(SurfaceBsdf* s, float3 n, float3 along, float* u) {
    const float squared = dot(n, n);
    n = squared > 0.0f && squared < INFINITY ? n : (float3)(0.0f, 0.0f, 1.0f);
    const float3 wo = world_to_frame(&s->frame, s->wo);
    bool turned = !(wo.z * dot(wo, n) > 0.0f);
    if (s->mode == BSDF_FLUX && !turned) {
        const bool is_decided = s->scale != 1.0f;
        turned = is_decided ? s->scale > 1.0f / (1.0f - TURNING_PROBABILITY) : decide(u, TURNING_PROBABILITY);
        s->scale = 1.0f / (turned ? TURNING_PROBABILITY : 1.0f - TURNING_PROBABILITY);
    }
    n = normalize(turned ? (float3)(-n.xy, n.z) : n);
    s->mapped = turned ? MAPPED_TURNED : MAPPED;
    s->unmapped = s->frame.n;
    s->tilt2 = map_tilt(n.z);
    const Frame tilted = frame_along(n, along);
    const Frame frame = s->frame;
    s->frame.tangent = frame_to_world(&frame, tilted.tangent);
    s->frame.bitangent = frame_to_world(&frame, tilted.bitangent);
    s->frame.n = frame_to_world(&frame, tilted.n);
}

/// Makes a parameter of a material part of the BSDF. Textures of numbers may leave the range from 0 to 1,
/// which the models rely on.
static inline void set_parameter(Bsdf* bsdf, uint parameter, const TextureValue* value) {
    const float2 number = clamp(value->number, 0.0f, 1.0f);
    switch (parameter) {
        case NEARLIGHT_PARAMETER_REFLECTANCE:
            bsdf->base = value->color;
            break;
        case NEARLIGHT_PARAMETER_SPECULAR:
            bsdf->specular = value->color;
            break;
        case NEARLIGHT_PARAMETER_TRANSMISSION:
            bsdf->transmission = bsdf->model == NEARLIGHT_BSDF_PRINCIPLED ? (float3)(number.x) : value->color;
            break;
        case NEARLIGHT_PARAMETER_ROUGHNESS:
            bsdf->alpha = number;
            break;
        case NEARLIGHT_PARAMETER_METALLIC:
            bsdf->metallic = number.x;
            break;
        case NEARLIGHT_PARAMETER_ANISOTROPIC:
            bsdf->anisotropic = number.x;
            break;
        case NEARLIGHT_PARAMETER_SPEC_TRANS:
            bsdf->spec_trans = number.x;
            break;
        case NEARLIGHT_PARAMETER_SPEC_TINT:
            bsdf->spec_tint = number.x;
            break;
        case NEARLIGHT_PARAMETER_SHEEN:
            bsdf->sheen = number.x;
            break;
        case NEARLIGHT_PARAMETER_SHEEN_TINT:
            bsdf->sheen_tint = number.x;
            break;
        case NEARLIGHT_PARAMETER_FLATNESS:
            bsdf->flatness = number.x;
            break;
        case NEARLIGHT_PARAMETER_CLEARCOAT:
            bsdf->clearcoat = number.x;
            break;
        default:
            bsdf->clearcoat_gloss = number.x;
    }
}

#define USES(parameter) (1u << NEARLIGHT_PARAMETER_##parameter)

/// Which parameters a model uses: bit i stands for the one of the number i.
static inline uint used_parameters(uint model) {
    switch (model) {
        case NEARLIGHT_BSDF_PLASTIC:
        case NEARLIGHT_BSDF_PHONG:
        case NEARLIGHT_BSDF_WARD:
            return USES(REFLECTANCE) | USES(SPECULAR) | USES(ROUGHNESS);
        case NEARLIGHT_BSDF_CONDUCTOR:
            return USES(SPECULAR) | USES(ROUGHNESS);
        case NEARLIGHT_BSDF_DIELECTRIC:
            return USES(SPECULAR) | USES(TRANSMISSION) | USES(ROUGHNESS);
        case NEARLIGHT_BSDF_THIN_DIELECTRIC:
            return USES(SPECULAR) | USES(TRANSMISSION);
        case NEARLIGHT_BSDF_PRINCIPLED:
            return USES(REFLECTANCE) | USES(TRANSMISSION) | USES(ROUGHNESS) | USES(METALLIC) |
                   USES(ANISOTROPIC) | USES(SPEC_TRANS) | USES(SPEC_TINT) | USES(SHEEN) | USES(SHEEN_TINT) |
                   USES(FLATNESS) | USES(CLEARCOAT) | USES(CLEARCOAT_GLOSS);
        case NEARLIGHT_BSDF_NULL:
            return 0u;
        default:  // diffuse, and models that stand for others
            return USES(REFLECTANCE);
    }
}

static inline Bsdf black_bsdf(void) {
    Bsdf bsdf;
    bsdf.model = NEARLIGHT_BSDF_DIFFUSE;
    bsdf.flags = 0;
    bsdf.diffuse = bsdf.base = bsdf.specular = bsdf.transmission = bsdf.k = (float3)(0.0f);
    bsdf.curve = 0;
    bsdf.alpha = (float2)(0.0f);
    bsdf.eta = (float3)(1.0f);
    bsdf.metallic = bsdf.anisotropic = bsdf.spec_trans = bsdf.spec_tint = bsdf.sheen = bsdf.sheen_tint =
        bsdf.flatness = bsdf.clearcoat = bsdf.clearcoat_gloss = 0.0f;
    bsdf.front = 1;
    bsdf.flux = 0;
    return bsdf;
}

/// The colour of D from looked-up parameters.
static inline float3 diffuse_color(const Bsdf* bsdf, const global Material* material) {
    const float3 base = bsdf->base;
    switch (bsdf->model) {
        case NEARLIGHT_BSDF_DIFFUSE:
        case NEARLIGHT_BSDF_PHONG:
        case NEARLIGHT_BSDF_WARD:
            return base;
        case NEARLIGHT_BSDF_PLASTIC: {
            // A texel above 1 would make the light between the base and the coat grow without an end.
            const float3 inside =
                bsdf->flags & NEARLIGHT_MATERIAL_NONLINEAR ? fmin(base, 1.0f) : (float3)(1.0f);
            return base / ((1.0f - inside * material->internal_reflectance) * bsdf->eta.x * bsdf->eta.x);
        }
        case NEARLIGHT_BSDF_PRINCIPLED: {
            const float share =
                bsdf->flags & NEARLIGHT_MATERIAL_THIN ? 1.0f - bsdf->transmission.x : 1.0f - bsdf->metallic;
            return base * (share * (1.0f - bsdf->spec_trans) * (1.0f - bsdf->flatness));
        }
        default:
            return (float3)(0.0f);
    }
}

/// Completes a BSDF with looked-up parameters for a viewer on the front (or back) side. Smooth glass becomes
/// clear where `clear` is set.
static inline void finish_bsdf(Bsdf* bsdf, const global Material* material, bool front, bool clear) {
    const bool straight = clear && material->model == NEARLIGHT_BSDF_DIELECTRIC && is_smooth(bsdf);
    const uint model = straight ? NEARLIGHT_BSDF_CLEAR_GLASS : material->model;
    const bool thin =
        straight || model == NEARLIGHT_BSDF_THIN_DIELECTRIC || (material->flags & NEARLIGHT_MATERIAL_THIN);
    const bool body = (model == NEARLIGHT_BSDF_DIELECTRIC || model == NEARLIGHT_BSDF_PRINCIPLED) && !thin;
    if (!front && !thin && !body && model != NEARLIGHT_BSDF_NULL) {
        *bsdf = black_bsdf();
        return;
    }
    bsdf->model = model;
    bsdf->flags = material->flags;
    bsdf->curve = material->curve;
    bsdf->front = front;
    bsdf->eta = load3(material->eta);
    bsdf->k = load3(material->k);
    if (body && !front) {
        bsdf->eta.x = 1.0f / bsdf->eta.x;
    }
    bsdf->diffuse = body && !front ? (float3)(0.0f) : diffuse_color(bsdf, material);
}

/// Turns the frame's normal to the other side.
static inline void turn_over(SurfaceBsdf* s) {
    s->frame.n = -s->frame.n;
    s->unmapped = -s->unmapped;
}

/// One step towards the model that stands behind `material`: applies one that stands for another, given the
/// value of its parameter, and returns the other. Returns null for a surface that is not there.
static inline const global Material* resolve_step(const SceneView* scene, const SurfaceHit* hit,
                                                  SurfaceBsdf* s, const global Material* material,
                                                  const TextureValue* value, float* turn, float* u) {
    uint child = 0;
    switch (material->model) {
        case NEARLIGHT_BSDF_MASK:
            if (!decide(u, clamp(value->number.x, 0.0f, 1.0f))) {
                return 0;
            }
            break;
        case NEARLIGHT_BSDF_BLEND:
            child = decide(u, clamp(value->number.x, 0.0f, 1.0f));
            break;
        case NEARLIGHT_BSDF_TWO_SIDED:
            child = dot(s->wo, s->frame.n) < 0.0f;
            if (child) {
                turn_over(s);
                *turn = -*turn;
            }
            break;
        case NEARLIGHT_BSDF_NORMAL_MAP:
            tilt_frame(s, 2.0f * value->color - 1.0f, (float3)(1.0f, 0.0f, 0.0f), u);
            break;
        default: {
            Frame front = s->frame;
            front.n *= *turn;
            float3 du;
            float3 dv;
            position_derivatives(scene, hit, &du, &dv);
            const float3 n = bumped_normal(hit, &front, du, dv, value->gradient);
            // Mitsuba's tangent under a bump map is this derivative in world space, taken for one in the
            // frame. Only anisotropy shows it.
            tilt_frame(s, n, du, u);
        }
    }
    return scene->materials + material->child[child];
}

/// Looks up the model behind `material` (which is none that stands for others) for the viewer s->wo.
static inline void look_up_bsdf(const SceneView* scene, const SurfaceHit* hit, SurfaceBsdf* s,
                                const global Material* material, float3 reflectance) {
    s->bsdf.model = material->model;
    s->bsdf.flags = material->flags;
    s->bsdf.base = reflectance;
    const uint used = used_parameters(material->model);
#pragma unroll 1
    for (uint i = 1; i < NEARLIGHT_PARAMETER_COUNT; ++i) {
        if (used >> i & 1u) {
            const TextureValue value = look_up(scene, &material->reflectance + i, hit);
            set_parameter(&s->bsdf, i, &value);
        }
    }
    const bool front = dot(s->wo, s->frame.n) > 0.0f;
    if (!front) {
        turn_over(s);
    }
    finish_bsdf(&s->bsdf, material, front,
                scene->info->veils == NEARLIGHT_VEILS_CLEAR && s->mode != BSDF_CAMERA);
}

/// The surface before its material is known: the frame is that of the mesh, and the BSDF is black.
static inline SurfaceBsdf bare_surface(const SurfaceHit* hit, float3 direction, uint mode) {
    SurfaceBsdf s;
    s.bsdf = black_bsdf();
    s.bsdf.flux = mode == BSDF_FLUX;
    s.frame = make_frame(hit->shading);
    s.geometric = hit->geometric;
    s.wo = -direction;
    s.mode = mode;
    s.unscaled = 0;
    s.s_probability = 0.0f;
    s.mapped = 0;
    s.unmapped = s.frame.n;
    s.tilt2 = 0.0f;
    s.scale = 1.0f;
    return s;
}

/// Whether the model needs its colour `reflectance`, which in most models only D does.
static inline bool needs_reflectance(const SurfaceBsdf* s, uint model, bool without_diffuse) {
    return !without_diffuse || s->mapped == MAPPED_TURNED || model == NEARLIGHT_BSDF_PRINCIPLED;
}

/// Resolves the material of the hit into s->bsdf and s->frame. `u` decides by chance at masks and blends, and
/// under maps in paths of flux. Without D, its colour is not looked up, and D is black, except under a map
/// that turned the normal.
static inline void resolve_material(const SceneView* scene, const SurfaceHit* hit, SurfaceBsdf* s, float u,
                                    bool without_diffuse) {
    const global Material* material = scene->materials + hit->material;
    float turn = 1.0f;  // −1 where a two-sided material turned the frame over
    bool aligned = false;
    for (uint step = 0; step <= NEARLIGHT_MAX_BSDF_NESTING; ++step) {
        if ((material->flags & NEARLIGHT_MATERIAL_TANGENT) && !aligned) {
            float3 du;
            float3 dv;
            position_derivatives(scene, hit, &du, &dv);
            s->frame = frame_along(turn * s->frame.n, du);
            s->frame.n *= turn;
            aligned = true;
        }
        const uint model = material->model;
        TextureValue value;
        value.color = (float3)(0.0f);
        if (model >= NEARLIGHT_BSDF_MASK || needs_reflectance(s, model, without_diffuse)) {
            value = look_up(scene, &material->reflectance, hit);
        }
        if (model < NEARLIGHT_BSDF_MASK) {
            look_up_bsdf(scene, hit, s, material, value.color);
            return;
        }
        material = resolve_step(scene, hit, s, material, &value, &turn, &u);
        if (!material) {
            s->bsdf.model = NEARLIGHT_BSDF_NULL;
            if (!(dot(s->wo, s->frame.n) > 0.0f)) {
                turn_over(s);
            }
            return;
        }
    }
}

#endif
