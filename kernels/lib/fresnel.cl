// SPDX-License-Identifier: Apache-2.0
// Fresnel reflectance of unpolarised light.
#ifndef NEARLIGHT_LIB_FRESNEL
#define NEARLIGHT_LIB_FRESNEL

/// Reflectance at a smooth boundary between dielectrics. `eta` is the index on the far side ÷ that on the
/// near side. `cos_far` gets the cosine on the far side. Under total reflection, the reflectance is 1 and
/// `cos_far` 0.
static inline float fresnel_dielectric(float cos_near, float eta, float* cos_far) {
    const float sin2_far = (1.0f - cos_near * cos_near) / (eta * eta);
    if (sin2_far >= 1.0f) {
        *cos_far = 0.0f;
        return 1.0f;
    }
    *cos_far = sqrt(1.0f - sin2_far);
    const float parallel = (eta * cos_near - *cos_far) / (eta * cos_near + *cos_far);
    const float perpendicular = (cos_near - eta * *cos_far) / (cos_near + eta * *cos_far);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// Reflectance of a metal with the index eta + i·k, colour by colour. [Born & Wolf, Principles of Optics,
/// §14.2]
static inline float3 fresnel_conductor(float cosine, float3 eta, float3 k) {
    const float cos2 = cosine * cosine;
    const float sin2 = 1.0f - cos2;
    const float3 t0 = eta * eta - k * k - sin2;
    const float3 a2_plus_b2 = sqrt(t0 * t0 + 4.0f * eta * eta * k * k);
    const float3 a = sqrt(fmax(0.5f * (a2_plus_b2 + t0), 0.0f));
    const float3 t1 = a2_plus_b2 + cos2;
    const float3 t2 = 2.0f * a * cosine;
    const float3 perpendicular = (t1 - t2) / (t1 + t2);
    const float3 t3 = cos2 * a2_plus_b2 + sin2 * sin2;
    const float3 t4 = t2 * sin2;
    const float3 parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return 0.5f * (perpendicular + parallel);
}

#endif
