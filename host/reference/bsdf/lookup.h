// SPDX-License-Identifier: Apache-2.0
// The parameters of models, and the normals of maps, looked up at a point of a surface.
#pragma once

#include "host/reference/bsdf/bsdf_model.h"
#include "host/reference/surface.h"

namespace nearlight::core {

/// The parameters of a material that stands for no other, seen from its front or back. One-sided models are
/// black on their back.
BsdfParameters bsdf_parameters(const Scene& scene, const Surface& surface, const Material& material,
                               bool front);

/// The opacity of a mask or the weight of a blend.
double share_at(const Scene& scene, const Surface& surface, const Material& material);
/// The normal of a normal map, in the frame of the surface.
Vec3d mapped_normal(const Scene& scene, const Surface& surface, const Material& material);
/// The normal of a bump map, in `frame`, which stands on the front.
Vec3d bumped_normal(const Scene& scene, const Surface& surface, const Material& material,
                    const BsdfFrame& frame);

}  // namespace nearlight::core
