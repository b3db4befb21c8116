// SPDX-License-Identifier: Apache-2.0
// What checks ask of the BSDF of a point (kernels/bsdf_probe.cl).
#ifndef NEARLIGHT_SHARED_BSDF_QUERY_H
#define NEARLIGHT_SHARED_BSDF_QUERY_H

#include "shared/vec3.h"

#ifdef __cplusplus
namespace nearlight::core {
#endif

/// A point of a triangle, a viewer, a direction of light and random numbers.
typedef struct BsdfQuery {
    Vec3 wo;                 // unit vector to the viewer, in world space
    uint triangle;           // index of the triangle
    Vec3 wi;                 // unit vector along which the BSDF is evaluated, in world space
    uint parts;              // BSDF_D, BSDF_S or both, of kernels/lib/bsdf/bsdf.cl
    float weight1, weight2;  // of the triangle's vertices v1 and v2
    uint mode;               // BSDF_CAMERA, BSDF_RADIANCE or BSDF_FLUX, of kernels/lib/bsdf/surface.cl
    float choice;            // the random number of masks and blends
    float u;                 // the random numbers of the sample
    float v[2];
    uint pad0;
} BsdfQuery;

/// The value along `wi`, and a direction drawn with the random numbers.
typedef struct BsdfAnswer {
    Vec3 value;        // BSDF · |cosine|
    float pdf;         // of `value`'s direction, per steradian
    Vec3 wi;           // direction that was drawn, in world space
    float sample_pdf;  // this and weight, eta and is_delta are those of its BsdfSample (bsdf_types.cl)
    Vec3 weight;
    float eta;
    Vec3 albedo;  // bsdf_albedo() of kernels/lib/bsdf/bsdf.cl
    uint is_delta;
} BsdfAnswer;

#ifdef __cplusplus
static_assert(sizeof(BsdfQuery) == 64 && sizeof(BsdfAnswer) == 64);
}  // namespace nearlight::core
#endif

#endif
