// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/reference.h"

#include <algorithm>

namespace nearlight::core {

Reference make_reference(const Scene& scene, uint id) {
    const Triangle& triangle = scene.triangles[id];
    Aabb box;
    box.extend(scene.vertices[triangle.v0].position);
    box.extend(scene.vertices[triangle.v1].position);
    box.extend(scene.vertices[triangle.v2].position);
    const float pad =
        0x1p-22f * std::max(max_component(max(box.max, -box.max)), max_component(max(box.min, -box.min)));
    const auto set = [pad](float& low, float& high, float min, float max) {
        low = (min - pad) + 0.0f;
        high = (max + pad) + 0.0f;
    };
    Reference reference{};
    set(reference.low[0], reference.high[0], box.min.x, box.max.x);
    set(reference.low[1], reference.high[1], box.min.y, box.max.y);
    set(reference.low[2], reference.high[2], box.min.z, box.max.z);
    reference.set_id(id);
    return reference;
}

}  // namespace nearlight::core
