// SPDX-License-Identifier: Apache-2.0
#include "host/samplers/incident_light.h"

#include <gtest/gtest.h>

#include "host/base/math.h"
#include "host/samplers/sparse_walks.h"
#include "tests/samplers/divided_room.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class IncidentLightTest : public test::DeviceTest {};

constexpr float kAlbedo = 0.7f;

/// A sphere of radius 1 with a lamp of 4π W in its middle: each bounce brings the same light to every place.
Scene bright_sphere() {
    using namespace small_scenes;
    Scene scene;
    add_inward_sphere(scene, 1.0f, 4, add_material(scene, lambertian({kAlbedo, kAlbedo, kAlbedo})));
    add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    set_camera(scene, {0, 0, 0}, {0, 0, 1}, 70);
    scene.camera.width = scene.camera.height = 32;
    return scene;
}

/// What arrives over up to `bounces` surfaces, W/m².
double expected_irradiance(uint bounces) {
    double sum = 0;
    for (uint bounce = 0; bounce <= bounces; ++bounce) {
        sum += std::pow(kAlbedo, bounce);
    }
    return sum;
}

/// The bound of the sparse set's light is as wide as the sphere's radius, so that paths bring much of it.
TEST_F(IncidentLightTest, IsThatOfAllBouncesWithOneLessThanVplsHave) {
    on_each_device([](Device& device) {
        test::SamplingBench bench(device, bright_sphere());
        for (const uint bounce_count : {1u, 2u, 3u, 6u}) {
            SamplingTask task = bench.task(SamplerKind::close_range, 500, 3, bounce_count);
            task.close_range.range = 10.0f;
            const std::vector<Vpl> points =
                trace_about(bench.stages(), task, empty_region(bench.stages(), task.scene), KeepDeposits::all,
                            2000)
                    .vpls;
            const SparseSet sparse = trace_sparse_set(bench.stages(), task, 500, 5);
            EXPECT_EQ(sparse.vpls.empty(), bounce_count == 1);
            double mean = 0;
            for (const Vec3 light : incident_light_at(bench.stages(), task, sparse, points,
                                                      {.direct_samples = 1, .paths = 16}, 7)) {
                mean += light.y / static_cast<double>(points.size());
            }
            const double expected = expected_irradiance(bounce_count - 1);
            EXPECT_NEAR(mean, expected, 0.01 * expected) << bounce_count << " bounces";
        }
    });
}

/// Of deposits of all depths, a sparse set takes those that have a bounce left, with the power of all.
TEST_F(IncidentLightTest, SparseSetsLeaveABounceToThePlacesTheyLight) {
    on_each_device([](Device& device) {
        test::SamplingBench bench(device, bright_sphere());
        const SamplingTask task = bench.task(SamplerKind::close_range, 500, 3, 3);
        const std::vector<Vpl> deposits =
            trace_about(bench.stages(), task, empty_region(bench.stages(), task.scene), KeepDeposits::all,
                        10'000)
                .vpls;
        const std::vector<float> weights(deposits.size(), 1.0f);
        const SparseSet sparse = draw_sparse_set(bench.stages(), task, deposits, weights, 500, 5);
        EXPECT_NEAR(static_cast<double>(sparse.vpls.count()), 500, 1);
        double power = 0;
        for (const Vpl& vpl : sparse.vpls.download()) {
            ASSERT_LT(vpl.depth, 3u);
            power += vpl.power.y;
        }
        const double expected = 4 * kPi * (kAlbedo + kAlbedo * kAlbedo);
        EXPECT_NEAR(power, expected, 0.01 * expected);
    });
}

}  // namespace
}  // namespace nearlight::core
