// SPDX-License-Identifier: Apache-2.0
// What one shared light brings to the receivers of a bundle that a work-group takes together: each work-item
// finds that of some receivers, and then all of them know the sums over the bundle.
#ifndef NEARLIGHT_LIB_BUNDLE_LIGHT
#define NEARLIGHT_LIB_BUNDLE_LIGHT

#include "lib/shared_light.cl"

/// One value for each receiver of the bundle, in local memory. The kernel gets it as arguments: PoCL 3.1
/// loses the address of a `local` variable in functions that it calls (docs/drivers.md).
#define BUNDLE_LIGHT_PARAMETERS \
    local float3 *brought_irradiance, local float *brought_geometry, local float *brought_density

#define BUNDLE_LIGHT \
    { brought_irradiance, brought_geometry, brought_density }

typedef struct BundleLight {
    local float3* irradiance;  // for a radiance of 1, times the density of rays to the light
    local float* geometry;     // G·V of a receiver that the lists say sees the light's place, or else 0
    local float* density;      // what the receiver's own rays add to the density, times π/m, or else 0
} BundleLight;

static inline void bring_nothing(const BundleLight* light, uint receiver) {
    light->irradiance[receiver] = (float3)(0.0f);
    light->geometry[receiver] = light->density[receiver] = 0.0f;
}

/// The sum over a bundle in the order of its receivers, so that every division of the work rounds alike.
static inline float sum_over_bundle(const local float* values) {
    float sum = 0.0f;
    for (uint i = 0; i < BUNDLE_RECEIVERS; ++i) {
        sum += values[i];
    }
    return sum;
}

/// Adds what the light brings to the receivers `item`, item + items, … of the bundle. `radiance` is that of
/// the light times its factor in the list, which is over the sum of the geometry terms.
static inline void add_bundle_light(const BundleLight* light, float3 radiance, const Bundle* bundle,
                                    uint item, uint items, global IrradiancePacket* irradiance) {
    const float density = sum_over_bundle(light->density);
    if (density > 0.0f) {
        radiance *= sum_over_bundle(light->geometry) / density;
        for (uint i = item; i < bundle->count * NEARLIGHT_PACKET_SIZE; i += items) {
            add_irradiance_to(irradiance + bundle->first + i / NEARLIGHT_PACKET_SIZE,
                              i % NEARLIGHT_PACKET_SIZE, radiance * light->irradiance[i]);
        }
    }
}

#endif
