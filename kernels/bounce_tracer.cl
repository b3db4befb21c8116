// SPDX-License-Identifier: Apache-2.0
// Indirect light by tracing paths from receivers: irradiance from surfaces nearer than R, each weighted by 1
// − r²/R². A gather with the clamp radius R leaves out just that part [Kollig & Keller, Illumination in the
// Presence of Weak Singularities, 2004], so the sum of the two is unbiased. With an infinite R, it is all the
// indirect light.
//
// A cosine-distributed ray that meets y at the distance r < R brings E(x) = π·L(y)·(1 − r²/R²), where π·L(y)
// = ρ(y)·E(y). E(y) is the direct light plus the light of the next cosine-distributed ray, which is not
// bounded, and so on to the end of the path. Few short rays meet anything, so few paths go far.
//
// One work-item for each lane; any work-group size. The result is added to `irradiance`. Random numbers are
// keyed by the receiver's position, so no split of the work changes the result.

#include "lib/light/direct.cl"
#include "lib/material.cl"
#include "lib/vpl.cl"

/// Irradiance at x through at most `bounce_count` reflections, estimated by one path. `first` chooses its
/// first direction, and `keys` its random numbers.
inline float3 trace_bounces(const SceneView* scene, float3 x, float3 n, float2 first, uint bounce_count,
                            float clamp_radius, uint4 keys) {
    const bool bounded = clamp_radius < INFINITY;
    float3 irradiance = (float3)(0.0f);
    float3 weight = (float3)(1.0f);
    float2 u = first;
    for (uint bounce = 0; bounce < bounce_count; ++bounce) {
        const float3 direction = to_world_frame(square_to_cosine_hemisphere(u), n);
        const SurfaceHit hit = trace_opaque(scene, x, direction, bounce == 0 ? clamp_radius : INFINITY);
        if (hit.t < 0.0f) {
            break;
        }
        const global Material* material = scene->materials + hit.material;
        if (!reflects(material, hit.front)) {
            break;
        }
        weight *= light_albedo(scene, material, hit.uv);
        if (bounce == 0 && bounded) {
            const float ratio = hit.t / clamp_radius;
            weight *= fmax(0.0f, 1.0f - ratio * ratio);
        }
        x = offset_point(scene, hit.position, hit.geometric);
        n = hit.geometric;
        const uint4 random = random_uint4((uint4)(keys.y, keys.z, keys.w, bounce));
        // From the third bounce on, weak paths end by chance.
        if (bounce >= 2) {
            const float survival = fmin(0.95f, fmax(weight.x, fmax(weight.y, weight.z)));
            if (!(to_unit_float(random.x) < survival)) {
                break;
            }
            weight /= survival;
        }
        irradiance += weight * direct_irradiance(scene, x, n, 1, random.w);
        u = (float2)(to_unit_float(random.y), to_unit_float(random.z));
    }
    return irradiance;
}

kernel void bounce_tracer(SCENE_PARAMETERS, const global ReceiverPacket* restrict receivers,
                          uint packet_count, uint sample_count, uint bounce_count, float clamp_radius,
                          uint seed, global IrradiancePacket* restrict irradiance) {
    const uint index = (uint)get_global_id(0);
    const uint packet = index / NEARLIGHT_PACKET_SIZE;
    const uint lane = index % NEARLIGHT_PACKET_SIZE;
    if (packet >= packet_count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const global ReceiverPacket* receiver = receivers + packet;
    const float3 x = receiver_position(receiver, lane);
    const float3 n = receiver_normal(receiver, lane);
    if (!(dot(n, n) > 0.0f) || scene.info->emitter_count == 0) {
        return;
    }
    const uint4 keys = random_uint4((uint4)(as_uint(x.x), as_uint(x.y), as_uint(x.z), seed));
    float3 sum = (float3)(0.0f);
    for (uint sample = 0; sample < sample_count; ++sample) {
        sum += trace_bounces(&scene, x, n, sample_2d(sample, 0, keys.x), bounce_count, clamp_radius,
                             random_uint4((uint4)(keys.y, keys.z, keys.w, sample)));
    }
    sum /= (float)sample_count;
    irradiance[packet].r[lane] += sum.x;
    irradiance[packet].g[lane] += sum.y;
    irradiance[packet].b[lane] += sum.z;
}
