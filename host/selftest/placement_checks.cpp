// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/checks.h"

#include <numeric>

#include "host/reference/close_range_oracle.h"
#include "host/reference/light_sampler.h"
#include "host/reference/test_rays.h"
#include "host/reference/test_rooms.h"
#include "host/scene/camera.h"
#include "host/scene/material_model.h"
#include "host/scene/ray_epsilon.h"
#include "host/scene/reflectance.h"
#include "host/stages/close_range.h"
#include "host/stages/device_scene.h"
#include "host/stages/light_visibility.h"
#include "host/stages/triangle_classifier.h"
#include "host/stages/vpl_placement.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kPlacementTriangles = 4000;
constexpr float kRange = 1.0f;
constexpr double kSlack = 5e-5;  ///< more than rounding can move a point of the soup by, m

TriangleCorners corners_of(const Scene& scene, uint id) {
    const Triangle& triangle = scene.triangles[id];
    return {scene.vertices[triangle.v0].position, scene.vertices[triangle.v1].position,
            scene.vertices[triangle.v2].position};
}

/// Maximum of the distances (m) of p from the triangle's plane and beyond its edges.
float distance_outside(const TriangleCorners& t, Vec3 p) {
    const Vec3 n = normalize(cross(t.b - t.a, t.c - t.a));
    float outside = std::abs(dot(n, p - t.a));
    for (const auto& [from, to] : {std::pair{t.a, t.b}, {t.b, t.c}, {t.c, t.a}}) {
        outside = std::max(outside, dot(normalize(cross(to - from, n)), p - from));
    }
    return outside;
}

/// A view of a part of the triangle soup.
CloseRange soup_region() {
    SceneCamera camera;
    camera.to_world = look_at({0.3, -0.2, -0.5}, {-0.4, 0.4, 1.0}, {0.3, 1, 0.2});
    camera.fov_x_degrees = 55;
    return make_close_range(make_camera(camera, 320, 200), kRange);
}

struct Classes {
    std::vector<uint> flags;
    std::vector<float> areas;  ///< of the parts between the planes, m²
};
Classes classify(Device& device, const Scene& scene, const CloseRange& region) {
    Buffer<uint> flags(device, kPlacementTriangles);
    Buffer<float> areas(device, kPlacementTriangles);
    TriangleClassifier(device).classify(
        Buffer<Vertex>(device, scene.vertices), Buffer<Triangle>(device, scene.triangles),
        upload_scene(device, scene, build_scene_bvh(scene)).materials,
        Buffer<CloseRange>(device, std::span(&region, 1)), false, kPlacementTriangles, flags, areas);
    return {flags.download(), areas.download()};
}

/// Points on the parts of triangles in the close range lie on the triangles and between the planes.
void check_points_on_parts(Device& device, CheckResult& result) {
    const Scene scene = make_triangle_soup(kPlacementTriangles, 21);
    const CloseRange region = soup_region();
    const Classes classes = classify(device, scene, region);
    std::vector<uint> ids;
    double sum = 0;
    for (uint i = 0; i < kPlacementTriangles; ++i) {
        if (classes.flags[i] != 0 && classes.areas[i] > 1e-4f) {
            ids.push_back(i);
            sum += classes.areas[i];
        }
    }
    VplPlacement placement(device);
    const PlacementSurface surface =
        placement.surface_of(Buffer<float>(device, classes.areas), Buffer<uint>(device, ids), ids.size(),
                             area_units_per_square_metre(sum));
    constexpr std::size_t kPoints = 10'000;
    Buffer<SurfaceSample> samples(device, kPoints);
    placement.place(surface, Buffer<Vertex>(device, scene.vertices),
                    Buffer<Triangle>(device, scene.triangles),
                    Buffer<CloseRange>(device, std::span(&region, 1)), false, kPoints, 7, samples);
    for (const SurfaceSample& point : samples.download()) {
        const bool known = point.triangle < kPlacementTriangles && classes.flags[point.triangle] != 0;
        result.expect(known && in_frustum(region, point.position, static_cast<float>(kSlack)) &&
                      distance_outside(corners_of(scene, point.triangle), point.position) < 1e-6f);
    }
}

/// A room with two lights, so that every point asks both of them. The spheres reflect outwards only.
Scene make_room_of_two_lights() {
    Scene scene = make_delta_lit_room();
    scene.delta_emitters = {scene.delta_emitters.front(), scene.delta_emitters.back()};
    scene.materials[1] = diffuse_material({0.5f, 0.5f, 0.5f});
    return scene;
}

/// Whether a light reaches the point on a side that reflects.
bool is_lit(const Scene& scene, const EmbreeScene& embree, uint id, Vec3 point, Vec3 scene_size) {
    const TriangleCorners t = corners_of(scene, id);
    const Vec3 front = normalize(cross(t.b - t.a, t.c - t.a));
    const float off = triangle_stand_off(t.a, t.b, t.c, scene_size);
    const bool two_sided = reflects_back(scene, scene.materials[scene.triangles[id].material]);
    for (const Emitter& light : scene.delta_emitters) {
        for (const Vec3 side : {front, -front}) {
            if ((side == front || two_sided) &&
                !is_zero(delta_light_irradiance(scene, embree, light, point + side * off, side))) {
                return true;
            }
        }
    }
    return false;
}

/// The fraction of a lattice of points on the triangle that light reaches.
double lit_share(const Scene& scene, const EmbreeScene& embree, uint id, Vec3 scene_size) {
    constexpr int kSteps = 15;
    const TriangleCorners t = corners_of(scene, id);
    int points = 0;
    int lit = 0;
    for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; i + j <= kSteps; ++j) {
            const float u = static_cast<float>(i) / kSteps;
            const float v = static_cast<float>(j) / kSteps;
            ++points;
            lit += is_lit(scene, embree, id, t.a * (1 - u - v) + t.b * u + t.c * v, scene_size) ? 1 : 0;
        }
    }
    return static_cast<double>(lit) / points;
}

}  // namespace

void check_classifier(Device& device, CheckResult& result) {
    const Scene scene = make_triangle_soup(kPlacementTriangles, 21);
    const CloseRange region = soup_region();
    const Classes found = classify(device, scene, region);
    for (uint i = 0; i < kPlacementTriangles; ++i) {
        const double area = triangle_area(scene, scene.triangles[i]);
        if (area < 1e-6) {
            continue;  // rounding decides whether it has any area
        }
        const TriangleCorners corners = corners_of(scene, i);
        const bool surely = nearest_squared_distance(corners, region, 0.0) < kRange * kRange;
        const bool perhaps =
            nearest_squared_distance(corners, region, kSlack) < (kRange + kSlack) * (kRange + kSlack);
        result.expect(found.flags[i] != 0 ? perhaps : !surely);
        if (found.flags[i] != 0) {
            const double part = found.areas[i] / area;
            result.expect(part > part_between_planes(corners, region, 0.0) - 1e-4 &&
                          part < part_between_planes(corners, region, kSlack) + 1e-4);
        }
    }
}

void check_light_visibility(Device& device, CheckResult& result) {
    constexpr uint kUntouched = 7;
    const Scene scene = make_room_of_two_lights();
    const DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
    const EmbreeScene embree(scene);
    std::vector<uint> ids;
    std::vector<uint> flags(scene.triangles.size(), kUntouched);
    for (uint id = 0; id < flags.size(); id += 2) {
        ids.push_back(id);
        flags[id] = 0;
    }
    Buffer<uint> selected(device, flags);
    LightVisibility(device).run(on_device, Buffer<uint>(device, ids), ids.size(), 3, selected);
    const std::vector<uint> found = selected.download();
    for (uint id = 0; id < found.size(); ++id) {
        if (id % 2 != 0) {
            result.expect(found[id] == kUntouched);
            continue;
        }
        const double share = lit_share(scene, embree, id, on_device.host_info.size);
        if (share == 0 || share == 1) {
            result.expect(found[id] == (share > 0 ? 1u : 0u));
        }
    }
}

void check_placement(Device& device, CheckResult& result) {
    const Scene scene = make_triangle_soup(kPlacementTriangles, 22);
    std::vector<uint> ids;
    std::vector<float> areas;
    std::vector<double> ends;  // sums of the areas up to and including ids[i]
    double sum = 0;
    for (uint i = 0; i < kPlacementTriangles; ++i) {
        areas.push_back(triangle_area(scene, scene.triangles[i]));
        if (areas[i] > 1e-4f) {
            ids.push_back(i);
            ends.push_back(sum += areas[i]);
        }
    }
    std::vector<std::size_t> place_of(kPlacementTriangles, ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        place_of[ids[i]] = i;
    }
    const CloseRange everything{};
    const Buffer<CloseRange> range(device, std::span(&everything, 1));
    VplPlacement placement(device);
    const PlacementSurface surface =
        placement.surface_of(Buffer<float>(device, areas), Buffer<uint>(device, ids), ids.size(),
                             area_units_per_square_metre(sum));
    result.expect(std::abs(surface.area - sum) < 1e-9 * sum);
    for (const std::size_t count : {std::size_t{1}, std::size_t{1000}, std::size_t{30'000}}) {
        Buffer<SurfaceSample> samples(device, count);
        placement.place(surface, Buffer<Vertex>(device, scene.vertices),
                        Buffer<Triangle>(device, scene.triangles), range, true, count, 7, samples);
        const std::vector<SurfaceSample> found = samples.download();
        const double part = sum / static_cast<double>(count);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t place =
                found[k].triangle < kPlacementTriangles ? place_of[found[k].triangle] : ids.size();
            if (place == ids.size()) {
                result.expect(false);
                continue;
            }
            const double begin = place == 0 ? 0.0 : ends[place - 1];
            const bool in_part = begin < part * static_cast<double>(k + 1) + 1e-9 * sum &&
                                 ends[place] > part * static_cast<double>(k) - 1e-9 * sum;
            result.expect(in_part &&
                          distance_outside(corners_of(scene, found[k].triangle), found[k].position) < 1e-6f);
        }
    }
    check_points_on_parts(device, result);
}

}  // namespace nearlight::core
