// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/placement_checks.h"

#include <numeric>

#include "host/scene/pinhole_camera.h"
#include "host/selftest/close_range_oracle.h"
#include "host/selftest/test_rays.h"
#include "host/stages/close_range.h"
#include "host/stages/triangle_classifier.h"
#include "host/stages/vpl_placement.h"

namespace nearlight {
namespace {

constexpr std::size_t kTriangles = 4000;

TriangleCorners corners_of(const Scene& scene, uint id) {
    const Triangle& triangle = scene.triangles[id];
    return {scene.vertices[triangle.v0].position, scene.vertices[triangle.v1].position,
            scene.vertices[triangle.v2].position};
}

/// How far p is from the plane of the triangle and outside its edges, m.
float distance_outside(const TriangleCorners& t, Vec3 p) {
    const Vec3 n = normalize(cross(t.b - t.a, t.c - t.a));
    float outside = std::abs(dot(n, p - t.a));
    for (const auto& [from, to] : {std::pair{t.a, t.b}, {t.b, t.c}, {t.c, t.a}}) {
        outside = std::max(outside, dot(normalize(cross(to - from, n)), p - from));
    }
    return outside;
}

}  // namespace

void check_classifier(Device& device, CheckResult& result) {
    constexpr float kRange = 1.0f;
    constexpr double kSlack = 5e-5;
    const Scene scene = make_triangle_soup(kTriangles, 21);
    SceneCamera camera;
    camera.to_world = look_at({0.3, -0.2, -0.5}, {-0.4, 0.4, 1.0}, {0.3, 1, 0.2});
    camera.fov_x_degrees = 55;
    const CloseRange region = make_close_range(make_pinhole_camera(camera, 320, 200), kRange);
    Buffer<uint> flags(device, kTriangles);
    Buffer<float> areas(device, kTriangles);
    TriangleClassifier(device).classify(
        Buffer<Vertex>(device, scene.vertices), Buffer<Triangle>(device, scene.triangles),
        Buffer<Material>(device, scene.materials), Buffer<CloseRange>(device, std::span(&region, 1)),
        kTriangles, flags, areas);
    const std::vector<uint> found = flags.download();
    for (uint i = 0; i < kTriangles; ++i) {
        if (triangle_area(scene, scene.triangles[i]) < 1e-6f) {
            continue;  // of no area, or so little that rounding decides whether there is any
        }
        const TriangleCorners corners = corners_of(scene, i);
        const bool surely = nearest_squared_distance(corners, region, 0.0) < kRange * kRange;
        const bool perhaps =
            nearest_squared_distance(corners, region, kSlack) < (kRange + kSlack) * (kRange + kSlack);
        result.expect(found[i] != 0 ? perhaps : !surely);
    }
}

void check_placement(Device& device, CheckResult& result) {
    const Scene scene = make_triangle_soup(kTriangles, 22);
    std::vector<uint> ids;
    std::vector<float> areas;
    std::vector<double> ends;  // of the area up to and including ids[i]
    double sum = 0;
    for (uint i = 0; i < kTriangles; ++i) {
        areas.push_back(triangle_area(scene, scene.triangles[i]));
        if (areas[i] > 1e-4f) {
            ids.push_back(i);
            ends.push_back(sum += areas[i]);
        }
    }
    std::vector<std::size_t> place_of(kTriangles, ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        place_of[ids[i]] = i;
    }
    const Buffer<uint> id_buffer(device, ids);
    VplPlacement placement(device);
    placement.set_surface(Buffer<float>(device, areas), id_buffer, ids.size(),
                          area_units_per_square_metre(sum));
    result.expect(std::abs(placement.total_area() - sum) < 1e-9 * sum);
    for (const std::size_t count : {std::size_t{1}, std::size_t{1000}, std::size_t{30'000}}) {
        Buffer<SurfaceSample> samples(device, count);
        const std::size_t placed =
            placement.place(Buffer<Vertex>(device, scene.vertices), Buffer<Triangle>(device, scene.triangles),
                            id_buffer, count, 7, samples);
        result.expect(placed == count);
        const std::vector<SurfaceSample> found = samples.download();
        const double part = sum / static_cast<double>(count);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t place =
                found[k].triangle < kTriangles ? place_of[found[k].triangle] : ids.size();
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
}

}  // namespace nearlight
