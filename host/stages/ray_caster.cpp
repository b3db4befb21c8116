// SPDX-License-Identifier: Apache-2.0
#include "host/stages/ray_caster.h"

namespace nearlight::core {

RayCaster::RayCaster(Device& device)
    : device_(&device),
      program_(device, "ray_caster.cl"),
      cast_closest_(program_, "cast_closest"),
      cast_any_(program_, "cast_any") {}

void RayCaster::cast(const DeviceTree& tree, const Buffer<RayQuery>& rays, Buffer<RayHit>& hits) {
    cast_closest_.launch_items(rays.count(), tree, rays, static_cast<uint>(rays.count()), hits);
}

std::vector<BvhHit> RayCaster::closest_hits(const Bvh& bvh, std::span<const RayQuery> rays) {
    const DeviceTree tree = upload_ray_tree(*device_, bvh);
    const Buffer<RayQuery> queries(*device_, rays);
    Buffer<RayHit> found(*device_, rays.size());
    cast(tree, queries, found);
    const std::vector<uint> triangle_ids = tree.triangle_ids.download();
    std::vector<BvhHit> hits;
    for (const RayHit& hit : found.download()) {
        hits.push_back(hit.slot == ~0u ? BvhHit{} : BvhHit{hit.t, hit.u, hit.v, triangle_ids[hit.slot]});
    }
    return hits;
}

std::vector<uint> RayCaster::any_hits(const Bvh& bvh, std::span<const RayQuery> rays) {
    return occluded(upload_ray_tree(*device_, bvh), rays);
}

std::vector<uint> RayCaster::occluded(const DeviceTree& tree, std::span<const RayQuery> rays) {
    if (rays.empty()) {
        return {};
    }
    const Buffer<RayQuery> queries(*device_, rays);
    const Buffer<uint> is_occluded(*device_, rays.size());
    cast_any_.launch_items(rays.size(), tree, queries, static_cast<uint>(rays.size()), is_occluded);
    return is_occluded.download();
}

}  // namespace nearlight::core
