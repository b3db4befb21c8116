// SPDX-License-Identifier: Apache-2.0
#include "host/reference/embree_scene.h"

#include <span>
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
    std::vector<uint> opaque_ids;
    std::vector<uint> glass_ids;
    EmbreeTree opaque;
    EmbreeTree glass;
    bool coherent = false;

    [[nodiscard]] BvhHit closest(RTCScene handle, std::span<const uint> ids, const RTCRay& ray) const {
        RTCRayHit query{};
        query.ray = ray;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        EmbreeQuery(coherent).intersect(handle, query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
            return {};
        }
        return {query.ray.tfar, query.hit.u, query.hit.v, ids[query.hit.primID]};
    }
};

EmbreeScene::EmbreeScene(const Scene& scene, const EmbreeOptions& options)
    : state_(std::make_unique<State>()) {
    State& state = *state_;
    state.device = open_embree(state.report);
    for (uint id = 0; id < scene.triangles.size(); ++id) {
        const bool glass = is_glass(scene.materials[scene.triangles[id].material]);
        (glass ? state.glass_ids : state.opaque_ids).push_back(id);
    }
    state.coherent = options.coherent;
    const auto build = [&](std::span<const uint> ids) {
        return build_embree_tree(state.device.get(), state.report, scene, ids, build_quality(options.quality),
                                 options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    };
    state.opaque = build(state.opaque_ids);
    state.glass = build(state.glass_ids);
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

BvhHit EmbreeScene::closest_hit(Vec3 origin, Vec3 direction, float t_min, float t_max) const {
    if (!is_traceable(origin, direction)) {
        return {};
    }
    const RTCRay ray = make_ray(origin, direction, t_min, t_max);
    return state_->closest(state_->opaque.get(), state_->opaque_ids, ray);
}

BvhHit EmbreeScene::closest_visible_hit(Vec3 origin, Vec3 direction, float t_min, float t_max) const {
    const BvhHit opaque = closest_hit(origin, direction, t_min, t_max);
    if (state_->glass_ids.empty() || !is_traceable(origin, direction)) {
        return opaque;
    }
    const RTCRay ray = make_ray(origin, direction, t_min, std::min(t_max, opaque.t));
    const BvhHit glass = state_->closest(state_->glass.get(), state_->glass_ids, ray);
    return glass.t < opaque.t ? glass : opaque;
}

bool EmbreeScene::occluded(Vec3 origin, Vec3 direction, float t_min, float t_max) const {
    if (!is_traceable(origin, direction)) {
        return false;
    }
    RTCRay ray = make_ray(origin, direction, t_min, t_max);
    EmbreeQuery(state_->coherent).occluded(state_->opaque.get(), ray);
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
    EmbreeQuery(state_->coherent).occluded(valid, state_->opaque.get(), reinterpret_cast<RTCRay16&>(rays));
    std::uint32_t occluded = 0;
    for (uint lane = 0; lane < 16; ++lane) {
        occluded |= (rays.t_max[lane] == -kInfinity ? 1u : 0u) << lane;
    }
    return occluded & active;
}

}  // namespace nearlight::core
