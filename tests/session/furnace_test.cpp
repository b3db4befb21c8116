// SPDX-License-Identifier: Apache-2.0
// Tests the whole renderer where the answer is known. Inside a sphere with a light at its centre, the
// geometry term is the same for any two points, so the indirect light is the direct light times Σ ρ^d.
#include <gtest/gtest.h>

#include <cmath>

#include "host/reference/close_range_oracle.h"
#include "host/scene/camera.h"
#include "host/session/session.h"
#include "host/stages/close_range.h"
#include "tests/session/rendering.h"
#include "tests/session/variants.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::render_image;

constexpr float kIntensity = 2.0f;
constexpr float kAlbedo = 0.6f;
/// The sphere is 1280 flat triangles: a point sees nothing of its own and less of its neighbours, and is
/// nearer to the light than the corners are.
constexpr double kFacets = 0.01;

Scene unit_furnace() {
    Scene scene;
    add_inward_sphere(scene, 1.0f, 3, add_material(scene, lambertian({kAlbedo, kAlbedo, kAlbedo})));
    add_point_light(scene, {0, 0, 0}, {kIntensity, kIntensity, kIntensity});
    set_camera(scene, {0, 0, 0}, {0.3, 0.2, 1}, 80);
    scene.camera.width = 24;
    scene.camera.height = 24;
    return scene;
}

RenderSettings furnace_settings(SamplerKind sampler, Policy policy, uint max_depth) {
    return {.view = {.range = 10.0f, .clamp_radius = 1e-3f, .max_depth = max_depth},
            .sampling = {.sampler = sampler, .policy = policy, .vpl_count = 3000, .close_fraction = 0.5f},
            .gather = {.samples_per_pixel = 1},
            .seed = 5};
}

/// Mean direct and indirect radiance over the picture.
std::pair<double, double> render_furnace(Device& device, const RenderSettings& settings) {
    const Image image = render_image(device, unit_furnace(), settings).image;
    return {channel_mean(image, "direct.G"), channel_mean(image, "indirect.G")};
}

/// The sum ρ^first + … + ρ^last.
double albedo_sum(uint first, uint last) {
    double sum = 0;
    for (uint d = first; d <= last; ++d) {
        sum += std::pow(double{kAlbedo}, d);
    }
    return sum;
}

/// Fraction of the sphere's area in triangles that reach into the view.
double share_in_view() {
    const Scene scene = unit_furnace();
    const CloseRange region = make_close_range(make_camera(scene.camera, 24, 24), 10.0f);
    double inside = 0;
    double all = 0;
    for (const Triangle& triangle : scene.triangles) {
        const TriangleCorners corners{scene.vertices[triangle.v0].position,
                                      scene.vertices[triangle.v1].position,
                                      scene.vertices[triangle.v2].position};
        const double area = triangle_area(scene, triangle);
        inside += std::isfinite(nearest_squared_distance(corners, region, 0.0)) ? area : 0.0;
        all += area;
    }
    return inside / all;
}

class Furnace : public test::DeviceTest {};

TEST_F(Furnace, EveryDepthAddsItsPowerOfTheAlbedo) {
    on_each_device([](Device& device) {
        for (const auto sampler : {SamplerKind::instant_radiosity, SamplerKind::close_range}) {
            SCOPED_TRACE(to_string(sampler));
            for (const uint max_depth : {2u, 3u, 4u, 7u}) {
                const auto [direct, indirect] =
                    render_furnace(device, furnace_settings(sampler, Policy::partition, max_depth));
                EXPECT_NEAR(direct, kIntensity * kAlbedo / kPi, kFacets * direct);
                const double expected = direct * albedo_sum(1, max_depth - 2);
                EXPECT_NEAR(indirect, expected, kFacets * expected) << "max depth " << max_depth;
            }
        }
    });
}

/// What a wide clamp radius takes from the VPLs, rays of receivers bring back, for every sampler.
TEST_F(Furnace, IndirectLightIsTheSameAtAnyClampRadius) {
    constexpr uint kMaxDepth = 6;
    const Scene scene = unit_furnace();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        for (const test::Variant& variant : test::all_variants()) {
            const auto indirect = [&](float clamp_radius, bool compensate, uint pictures = 1) {
                double mean = 0.0;
                for (uint seed = 0; seed < pictures; ++seed) {
                    RenderSettings settings = furnace_settings(variant.sampler, variant.policy, kMaxDepth);
                    settings.view.clamp_radius = clamp_radius;
                    settings.gather.compensate = compensate;
                    settings.seed += seed;
                    mean += channel_mean(render_image(session, settings).image, "indirect.G") / pictures;
                }
                return mean;
            };
            if (variant.policy != Policy::paper) {
                SCOPED_TRACE(variant.name());
                const double expected = kIntensity * kAlbedo / kPi * albedo_sum(1, kMaxDepth - 2);
                EXPECT_NEAR(indirect(0.015f, true), expected, 2 * kFacets * expected);
                // A radius wider than the sphere leaves all light to rays, of which each bundle shares a few.
                EXPECT_NEAR(indirect(1.5f, true, 4), expected, 2 * kFacets * expected);
                EXPECT_LT(indirect(1.5f, false), 0.9 * expected) << "the clamp radius takes nothing away";
            }
        }
    });
}

/// The paper's step 3 drops light that arrives in the close range after two or more bounces: the terms of Σ
/// ρ^d from d = 2 on, in the fraction of the surface that counts as close.
TEST_F(Furnace, PolicyPaperLosesExactlyMultiBounceLightInTheCloseRange) {
    const double close = share_in_view();
    ASSERT_GT(close, 0.1);
    on_each_device([&](Device& device) {
        constexpr uint kMaxDepth = 7;
        const auto mean = [&](Policy policy) {
            const auto [direct, indirect] =
                render_furnace(device, furnace_settings(SamplerKind::close_range, policy, kMaxDepth));
            return indirect / direct;
        };
        const double complete = albedo_sum(1, kMaxDepth - 2);
        const double lost = close * albedo_sum(2, kMaxDepth - 2);
        ASSERT_GT(lost, 5 * kFacets * complete) << "too little to tell";
        EXPECT_NEAR(mean(Policy::partition), complete, kFacets * complete);
        EXPECT_NEAR(mean(Policy::paper), complete - lost, kFacets * complete);
    });
}

/// What a wide clamp radius takes from the gather, short paths bring back.
TEST_F(Furnace, IrradianceAtPointsIsThatOfAllDepthsAtAnyClampRadius) {
    constexpr uint kMaxDepth = 6;
    const Scene scene = unit_furnace();
    std::vector<Vec3> points;
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < scene.triangles.size(); i += 7) {
        const Triangle& triangle = scene.triangles[i];
        points.push_back((1.0f / 3.0f) *
                         (scene.vertices[triangle.v0].position + scene.vertices[triangle.v1].position +
                          scene.vertices[triangle.v2].position));
        normals.push_back(normalize(-1.0f * points.back()));
    }
    on_each_device([&](Device& device) {
        Session session(device, scene);
        const auto mean = [&](float clamp_radius, uint paths) {
            const View view = session.look({.clamp_radius = clamp_radius, .max_depth = kMaxDepth}, 1);
            const VplSet vpls =
                session.sample(view, {.sampler = SamplerKind::instant_radiosity, .vpl_count = 3000}, 1);
            double sum = 0;
            for (const Vec3 e :
                 session.irradiance(points, normals, view, vpls, {.direct_samples = 1, .paths = paths}, 1)) {
                sum += e.y;
            }
            return sum / static_cast<double>(points.size());
        };
        const double expected = kIntensity * (1 + albedo_sum(1, kMaxDepth - 2));
        EXPECT_NEAR(mean(0.01f, 64), expected, 2 * kFacets * expected);
        EXPECT_NEAR(mean(1.5f, 64), expected, 2 * kFacets * expected);
        EXPECT_LT(mean(1.5f, 0), 0.95 * expected) << "the clamp radius takes nothing away";
    });
}

TEST_F(Furnace, IrradianceRefusesPointsWithoutNormals) {
    on_each_device([&](Device& device) {
        const Scene scene = unit_furnace();
        Session session(device, scene);
        const View view = session.look({}, 1);
        const VplSet vpls = session.sample(view, {}, 1);
        const std::vector<Vec3> points(3);
        const std::vector<Vec3> normals(2);
        EXPECT_THROW(session.irradiance(points, normals, view, vpls, {}, 1), Error);
    });
}

}  // namespace
}  // namespace nearlight::core
