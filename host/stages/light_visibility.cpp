// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_visibility.h"

namespace nearlight::core {
namespace {

/// The area per test point, as a part of the scene's area: a square of a few centimetres in a hall. Smaller
/// triangles get a single point.
constexpr double kAreaPerPoint = 1e-6;

}  // namespace

LightVisibility::LightVisibility(Device& device)
    : program_(device, "light_visibility.cl"), light_visibility_(program_, "light_visibility") {}

void LightVisibility::run(const DeviceScene& scene, const Buffer<uint>& ids, std::size_t id_count, uint seed,
                          Buffer<uint>& selected) {
    light_visibility_.launch_items(id_count, scene, ids, static_cast<uint>(id_count),
                                   static_cast<float>(kAreaPerPoint * scene.total_area), seed, selected);
}

}  // namespace nearlight::core
