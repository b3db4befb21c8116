// SPDX-License-Identifier: Apache-2.0
#include "host/reference/embree_scene.h"

#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/base/math.h"
#include "host/reference/embree_tree.h"

namespace nearlight::core {
namespace {

static_assert(sizeof(Rays16) == sizeof(RTCRay16) && alignof(Rays16) == alignof(RTCRay16));
static_assert(offsetof(Rays16, direction_x) == offsetof(RTCRay16, dir_x));
static_assert(offsetof(Rays16, t_max) == offsetof(RTCRay16, tfar));

// Fraction of a segment at each end that is ignored, so that the surfaces of its end points do not occlude
// it.
constexpr float kSegmentMargin = 1e-5f;

RTCBuildQuality build_quality(EmbreeOptions::Quality quality) {
    switch (quality) {
        case EmbreeOptions::Quality::low:
            return RTC_BUILD_QUALITY_LOW;
        case EmbreeOptions::Quality::medium:
            return RTC_BUILD_QUALITY_MEDIUM;
        case EmbreeOptions::Quality::high:
            return RTC_BUILD_QUALITY_HIGH;
    }
    return RTC_BUILD_QUALITY_MEDIUM;
}

/// Whether Embree can trace the ray. Its answers for NaN are undefined.
bool is_traceable(Vec3 origin, Vec3 direction) {
    return is_finite(origin) && is_finite(direction) && !is_zero(direction);
}

RTCRay make_ray(Vec3 origin, Vec3 direction, float t_min, float t_max) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.tnear = t_min;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = t_max;
    ray.mask = ~0u;
    return ray;
}

}  // namespace

struct EmbreeScene::State {
    EmbreeReport report;
    EmbreeDevice device;
    EmbreeTree tree;
    bool coherent = false;
};

EmbreeScene::EmbreeScene(const Scene& scene, const EmbreeOptions& options)
    : state_(std::make_unique<State>()) {
    State& state = *state_;
    state.device = open_embree(state.report);
    state.coherent = options.coherent;
    std::vector<uint> ids(scene.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    state.tree =
        build_embree_tree(state.device.get(), state.report, scene, ids, build_quality(options.quality),
                          options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

BvhHit EmbreeScene::closest_hit(Vec3 origin, Vec3 direction, float t_min, float t_max) const {
    if (!is_traceable(origin, direction)) {
        return {};
    }
    RTCRayHit query{};
    query.ray = make_ray(origin, direction, t_min, t_max);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    EmbreeQuery(state_->coherent).intersect(state_->tree.get(), query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return {};
    }
    return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
}

bool EmbreeScene::occluded(Vec3 origin, Vec3 direction, float t_min, float t_max) const {
    if (!is_traceable(origin, direction)) {
        return false;
    }
    RTCRay ray = make_ray(origin, direction, t_min, t_max);
    EmbreeQuery(state_->coherent).occluded(state_->tree.get(), ray);
    return ray.tfar == -kInfinity;
}

bool EmbreeScene::blocked(Vec3 from, Vec3 to) const {
    return occluded(from, to - from, kSegmentMargin, 1.0f - kSegmentMargin);
}

std::uint32_t EmbreeScene::occluded16(Rays16& rays, std::uint32_t active) const {
    alignas(64) int valid[16];
    for (uint lane = 0; lane < 16; ++lane) {
        valid[lane] = (active >> lane & 1u) != 0u ? -1 : 0;
        rays.mask[lane] = ~0u;
        rays.flags[lane] = 0;
        rays.time[lane] = 0.0f;
    }
    EmbreeQuery(state_->coherent).occluded(valid, state_->tree.get(), reinterpret_cast<RTCRay16&>(rays));
    std::uint32_t occluded = 0;
    for (uint lane = 0; lane < 16; ++lane) {
        occluded |= (rays.t_max[lane] == -kInfinity ? 1u : 0u) << lane;
    }
    return occluded & active;
}

}  // namespace nearlight::core
