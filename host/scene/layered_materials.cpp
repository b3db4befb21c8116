// SPDX-License-Identifier: Apache-2.0
#include "host/scene/layered_materials.h"

#include <algorithm>
#include <cmath>

#include "host/scene/material_model.h"

namespace nearlight::core {
namespace {

/// Curves take milliseconds to compute. So many steps between 0 and 1 are as good as any number.
constexpr double kStepsToOne = 64;

double in_steps(double number) {
    return std::round(std::clamp(number, 0.0, 1.0) * kStepsToOne) / kStepsToOne;
}

}  // namespace

Material LayeredMaterials::of(Scene& scene, const Layers& layers) {
    const Layers rounded{.eta = layers.eta,
                         .roughness = in_steps(layers.roughness),
                         .clearcoat = in_steps(layers.clearcoat),
                         .sheen = in_steps(layers.sheen)};
    const auto [known, is_new] = made_.try_emplace(rounded);
    if (is_new) {
        Material material = plain_material(NEARLIGHT_BSDF_PRINCIPLED);
        const auto eta = static_cast<float>(layers.eta);
        material.eta = {eta, eta, eta};
        material.flags |= NEARLIGHT_MATERIAL_LAYERED;
        material.curve = add_curve(scene, layered_curve(rounded));
        known->second = material;
    }
    return known->second;
}

}  // namespace nearlight::core
