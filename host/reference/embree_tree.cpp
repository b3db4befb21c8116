// SPDX-License-Identifier: Apache-2.0
#include "host/reference/embree_tree.h"

#include "nearlight/error.h"

namespace nearlight::core {
namespace {

void record_error(void* user, RTCError code, const char* message) {
    auto& report = *static_cast<EmbreeReport*>(user);
    const std::scoped_lock lock(report.mutex);
    if (report.code == RTC_ERROR_NONE) {
        report.code = code;
        report.message = message != nullptr ? message : "no message";
    }
}

void throw_if_failed(const EmbreeReport& report) {
    if (report.code != RTC_ERROR_NONE) {
        const auto code =
            report.code == RTC_ERROR_OUT_OF_MEMORY ? ErrorKind::out_of_memory : ErrorKind::failure;
        throw Error(code, "Embree could not build its scene: " + report.message + " (error " +
                              std::to_string(report.code) + "); use a smaller scene or free memory");
    }
}

EmbreeGeometry make_geometry(RTCDevice device, const Scene& scene, std::span<const uint> ids) {
    EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* positions = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), scene.vertices.size()));
    auto* indices = static_cast<uint*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint), ids.size()));
    if (positions == nullptr || indices == nullptr) {
        return nullptr;  // `report` has the reason
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

}  // namespace

EmbreeDevice open_embree(EmbreeReport& report) {
    EmbreeDevice device(rtcNewDevice(nullptr));
    if (device == nullptr) {
        throw Error(ErrorKind::failure, "Embree does not start on this machine (error " +
                                            std::to_string(rtcGetDeviceError(nullptr)) + ")");
    }
    rtcSetDeviceErrorFunction(device.get(), record_error, &report);
    return device;
}

EmbreeTree build_embree_tree(RTCDevice device, EmbreeReport& report, const Scene& scene,
                             std::span<const uint> ids, RTCBuildQuality quality, RTCSceneFlags flags) {
    EmbreeTree tree(rtcNewScene(device));
    if (tree != nullptr) {
        rtcSetSceneFlags(tree.get(), flags);
        rtcSetSceneBuildQuality(tree.get(), quality);
        if (!ids.empty()) {
            if (const EmbreeGeometry geometry = make_geometry(device, scene, ids)) {
                rtcAttachGeometry(tree.get(), geometry.get());
            }
        }
        rtcCommitScene(tree.get());
    }
    throw_if_failed(report);
    return tree;
}

}  // namespace nearlight::core
