// SPDX-License-Identifier: Apache-2.0
#include "host/reference/embree_scene.h"

#include <embree3/rtcore.h>

#include <limits>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/reference/embree_handles.h"

namespace nearlight {
namespace {

static_assert(sizeof(RayPacket16) == sizeof(RTCRay16) && alignof(RayPacket16) == alignof(RTCRay16));
static_assert(offsetof(RayPacket16, direction_x) == offsetof(RTCRay16, dir_x));
static_assert(offsetof(RayPacket16, t_max) == offsetof(RTCRay16, tfar));

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Of a segment: what its end points' own surfaces may take.
constexpr float kSegmentMargin = 1e-5f;

/// The first error that Embree reported, possibly from a thread of its own.
struct Report {
    std::mutex mutex;
    RTCError code = RTC_ERROR_NONE;
    std::string message;
};

void record_error(void* user, RTCError code, const char* message) {
    auto& report = *static_cast<Report*>(user);
    const std::scoped_lock lock(report.mutex);
    if (report.code == RTC_ERROR_NONE) {
        report.code = code;
        report.message = message != nullptr ? message : "no message";
    }
}

[[noreturn]] void throw_report(const Report& report) {
    const auto code = report.code == RTC_ERROR_OUT_OF_MEMORY ? ExitCode::out_of_memory : ExitCode::runtime;
    throw Error(code, "Embree could not build its scene: " + report.message + " (error " +
                          std::to_string(report.code) + "); use a smaller scene or free memory");
}

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

EmbreeGeometry make_geometry(RTCDevice device, const Scene& scene, std::span<const uint> ids) {
    EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* positions = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), scene.vertices.size()));
    auto* indices = static_cast<uint*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint), ids.size()));
    if (positions == nullptr || indices == nullptr) {
        return nullptr;  // the error callback has the reason
    }
    for (const Vertex& vertex : scene.vertices) {
        *positions++ = vertex.position;
    }
    for (const uint id : ids) {
        const Triangle& triangle = scene.triangles[id];
        *indices++ = triangle.v0;
        *indices++ = triangle.v1;
        *indices++ = triangle.v2;
    }
    rtcCommitGeometry(geometry.get());
    return geometry;
}

EmbreeTree make_scene(RTCDevice device, const Scene& scene, std::span<const uint> ids,
                      const EmbreeOptions& options) {
    EmbreeTree handle(rtcNewScene(device));
    if (handle == nullptr) {
        return handle;
    }
    rtcSetSceneFlags(handle.get(), options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(handle.get(), build_quality(options.quality));
    if (!ids.empty()) {
        if (const EmbreeGeometry geometry = make_geometry(device, scene, ids)) {
            rtcAttachGeometry(handle.get(), geometry.get());
        }
    }
    rtcCommitScene(handle.get());
    return handle;
}

/// Embree may return anything for NaN, so such rays do not reach it.
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
    Report report;
    EmbreeDevice device;
    std::vector<uint> opaque_ids;
    std::vector<uint> glass_ids;
    EmbreeTree opaque;
    EmbreeTree glass;
    RTCIntersectContextFlags context_flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;

    [[nodiscard]] RTCIntersectContext make_context() const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = context_flags;
        return context;
    }

    [[nodiscard]] BvhHit closest(RTCScene handle, std::span<const uint> ids, const RTCRay& ray) const {
        RTCRayHit query{};
        query.ray = ray;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context = make_context();
        rtcIntersect1(handle, &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
            return {};
        }
        return {query.ray.tfar, query.hit.u, query.hit.v, ids[query.hit.primID]};
    }
};

EmbreeScene::EmbreeScene(const Scene& scene, const EmbreeOptions& options)
    : state_(std::make_unique<State>()) {
    State& state = *state_;
    state.device.reset(rtcNewDevice(nullptr));
    if (state.device == nullptr) {
        throw Error(ExitCode::runtime, "Embree does not start on this machine (error " +
                                           std::to_string(rtcGetDeviceError(nullptr)) + ")");
    }
    rtcSetDeviceErrorFunction(state.device.get(), record_error, &state.report);
    for (uint id = 0; id < scene.triangles.size(); ++id) {
        const bool glass = is_glass(scene.materials[scene.triangles[id].material]);
        (glass ? state.glass_ids : state.opaque_ids).push_back(id);
    }
    state.context_flags =
        options.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    state.opaque = make_scene(state.device.get(), scene, state.opaque_ids, options);
    state.glass = make_scene(state.device.get(), scene, state.glass_ids, options);
    if (state.report.code != RTC_ERROR_NONE) {
        throw_report(state.report);
    }
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
    RTCIntersectContext context = state_->make_context();
    rtcOccluded1(state_->opaque.get(), &context, &ray);
    return ray.tfar == -kInfinity;
}

bool EmbreeScene::blocked(Vec3 from, Vec3 to) const {
    return occluded(from, to - from, kSegmentMargin, 1.0f - kSegmentMargin);
}

std::uint32_t EmbreeScene::occluded16(RayPacket16& rays, std::uint32_t active) const {
    alignas(64) int valid[16];
    for (uint lane = 0; lane < 16; ++lane) {
        valid[lane] = (active >> lane & 1u) != 0u ? -1 : 0;
        rays.mask[lane] = ~0u;
        rays.flags[lane] = 0;
        rays.time[lane] = 0.0f;
    }
    RTCIntersectContext context = state_->make_context();
    rtcOccluded16(valid, state_->opaque.get(), &context, reinterpret_cast<RTCRay16*>(&rays));
    std::uint32_t occluded = 0;
    for (uint lane = 0; lane < 16; ++lane) {
        occluded |= (rays.t_max[lane] == -kInfinity ? 1u : 0u) << lane;
    }
    return occluded & active;
}

}  // namespace nearlight
