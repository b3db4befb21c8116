// SPDX-License-Identifier: Apache-2.0
// Kernels that take light samples at a receiver and ask for their densities.
#pragma once

#include <array>
#include <string>

namespace nearlight::core::light_probes {

using Float4 = std::array<float, 4>;
inline constexpr Float4 kOrigin{0, 0, 0, 0};
inline constexpr Float4 kUp{0, 0, 1, 0};
inline constexpr Float4 kNoLobe{0, 0, 1, 0};

/// Begins the probes: the radiance of the sky in a direction, as rays of pictures find it.
inline const std::string kSkyProbe = R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
static inline float3 sky_radiance(const SceneView* scene, const LightReceiver* at, float3 direction) {
    const MapSample map = map_sample_towards(scene, direction);
    const LightSample sky = sample_of_sky(scene, at, &map);
    return light_radiance(scene, &sky);
}
)";

/// Takes samples at the receiver, which has a lobe of the roughness viewer.w if that is not 0, and asks for
/// the density of the direction of each by tracing it. `out` gets (density of the sample, density by
/// light_pdf, radiance found ÷ radiance of the sample, 1 if visible).
inline const std::string kSampleProbe = kSkyProbe + R"(
kernel void probe(SCENE_PARAMETERS, float4 position, float4 normal, float4 viewer, uint count, global float4* out) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const float3 x = position.xyz;
    const float3 n = normal.xyz;
    const LightReceiver at = glossy_receiver(x, n, viewer.xyz, 1.0f, viewer.w);
    const LightSample light = sample_light(&scene, &at, sample_2d(i, 0, 7), sample_2d(i, 1, 7));
    const SurfaceHit hit = trace_surface(&scene, x, light.direction, INFINITY);
    const float3 found = hit.t < 0.0f ? sky_radiance(&scene, &at, light.direction)
                                      : emitted_radiance(&scene, &hit);
    out[i] = (float4)(light.pdf, light_pdf(&scene, &at, light.direction, &hit), found.y / light_radiance(&scene, &light).y,
                      may_shine(&light) ? (float)light_is_visible(&scene, x, &light) : 0.0f);
}
)";

/// Density by light_pdf of directions that are uniform over the sphere, for such a receiver.
inline constexpr const char* kDensityProbe = R"(
#include "lib/light/sample.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, float4 position, float4 normal, float4 viewer, uint count, global float* out) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const float3 direction = square_to_cap(sample_2d(i, 0, 9), 2.0f);
    const SurfaceHit hit = trace_surface(&scene, position.xyz, direction, INFINITY);
    const LightReceiver at = glossy_receiver(position.xyz, normal.xyz, viewer.xyz, 1.0f, viewer.w);
    out[i] = light_pdf(&scene, &at, direction, &hit);
}
)";

/// Irradiance by light samples combined with cosine-distributed rays.
inline const std::string kCombinedProbe = kSkyProbe + R"(
#include "lib/receiver_path.cl"
kernel void probe(SCENE_PARAMETERS, float4 position, float4 normal, uint light_samples, uint rays, uint count,
                  global float4* out) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const float3 x = position.xyz;
    const float3 n = normal.xyz;
    const ReceiverPoint at = {x, n, (float3)(0.0f), 0};
    const LightReceiver receiver = even_receiver(x, n);
    const LightQuota quota = {.samples = light_samples, .rays = rays};
    float3 sum = sampled_direct_light(&scene, &at, &quota, i);
    for (uint ray = 0; ray < rays; ++ray) {
        const float3 direction = to_world_frame(square_to_cosine_hemisphere(sample_2d(ray, 5, i)), n);
        const SurfaceHit hit = trace_surface(&scene, x, direction, INFINITY);
        const float3 found = hit.t < 0.0f ? sky_radiance(&scene, &receiver, direction)
                                          : emitted_radiance(&scene, &hit);
        const float own = (float)rays * dot(n, direction) * M_1_PI_F;
        const float other = (float)light_samples * light_pdf(&scene, &receiver, direction, &hit);
        sum += found * (M_PI_F / (float)rays * own / (own + other));
    }
    out[i] = (float4)(sum, 0.0f);
}
)";

}  // namespace nearlight::core::light_probes
