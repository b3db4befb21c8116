// SPDX-License-Identifier: Apache-2.0
#include "host/session/passes.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class Passes : public test::DeviceTest {};

/// A floor and a wall under a lamp and a sky.
Scene yard() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.6f, 0.5f, 0.4f}));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, grey);
    add_quad(scene, {-2, -1, 1}, {0, 2, 0}, {4, 0, 0}, grey);
    add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, lamp));
    scene.environment = {.width = 1, .height = 1, .radiance = {{0.3f, 0.4f, 0.5f}}, .to_world = {}};
    set_camera(scene, {0.1, 0.6, -1.9}, {0, -0.5, 1}, 70);
    scene.camera.width = 40;
    scene.camera.height = 24;
    return scene;
}

RenderSettings with_passes(RenderSettings settings, uint passes) {
    settings.passes = passes;
    return settings;
}

/// Whether passes average the value at `index` in finished rows.
bool is_averaged(std::size_t index) {
    return pass_rules()[index % NEARLIGHT_LAYER_CHANNELS] == PassRule::mean;
}

/// Values of the layers that passes average, and of the others.
struct Differences {
    double light = 0;
    double geometry = 0;
};
Differences largest_differences(const Image& a, const Image& b) {
    Differences largest;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        double& difference = is_averaged(i) ? largest.light : largest.geometry;
        difference = std::max(difference, std::abs(double{a.values[i]} - b.values[i]));
    }
    return largest;
}

TEST(PassSeed, NoTwoPassesOfNeighbouringSeedsAreAlike) {
    EXPECT_EQ(pass_seed(7, 0), 7u);
    std::set<uint> seeds;
    for (uint seed = 0; seed < 100; ++seed) {
        for (uint pass = 0; pass < 100; ++pass) {
            seeds.insert(pass_seed(seed, pass));
        }
    }
    EXPECT_GE(seeds.size(), 9998u);  // among 10⁴ random numbers of 32 bits, 0.01 equal pairs are expected
}

TEST_F(Passes, OneIsThePictureBitForBit) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        const test::Rendering plain = test::render_image(session, test::few_vpls());
        const test::Rendering one = test::render_image(session, with_passes(test::few_vpls(), 1));
        EXPECT_EQ(one.report.image_hash, plain.report.image_hash);
        RenderSettings hurried = test::few_vpls();
        hurried.seconds = 0;  // the first pass is still made, and is the only one
        const test::Rendering first = test::render_image(session, hurried);
        EXPECT_EQ(first.report.passes, 1u);
        EXPECT_EQ(first.report.image_hash, plain.report.image_hash);
        EXPECT_EQ(first.image.values, plain.image.values);
    });
}

TEST_F(Passes, AreTheMeanOfPicturesWithTheirSeeds) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        for (const SamplerKind sampler : {SamplerKind::close_range, SamplerKind::local}) {
            constexpr uint kPasses = 3;
            RenderSettings settings = test::few_vpls(sampler);
            const test::Rendering averaged = test::render_image(session, with_passes(settings, kPasses));
            Image expected;
            std::size_t vpls = 0;
            for (uint pass = 0; pass < kPasses; ++pass) {
                settings.seed = pass_seed(5, pass);
                if (pass > 0) {
                    settings.view.range = averaged.report.range;
                    const RayBudget& budget = averaged.report.ray_budget;
                    settings.view.clamp_radius = budget.clamp_radius;
                    settings.gather.direct_samples_per_pixel = budget.light_samples_per_pixel;
                }
                const test::Rendering single = test::render_image(session, settings);
                vpls += single.report.close_vpls + single.report.distant_vpls;
                if (pass == 0) {
                    expected = single.image;
                    EXPECT_GT(largest_differences(expected, averaged.image).light, 1e-3);
                    continue;
                }
                for (std::size_t i = 0; i < expected.values.size(); ++i) {
                    expected.values[i] += is_averaged(i) ? single.image.values[i] : 0.0f;
                }
            }
            for (std::size_t i = 0; i < expected.values.size(); ++i) {
                expected.values[i] /= is_averaged(i) ? kPasses : 1.0f;
            }
            const Differences differences = largest_differences(expected, averaged.image);
            EXPECT_LT(differences.light, 1e-5) << to_string(sampler);
            EXPECT_EQ(differences.geometry, 0.0) << to_string(sampler);
            EXPECT_EQ(averaged.report.passes, kPasses);
            EXPECT_EQ(averaged.report.close_vpls + averaged.report.distant_vpls, vpls);
            EXPECT_FALSE(averaged.report.interrupted);
        }
    });
}

TEST_F(Passes, StopWhereTheTimeIsUsedOrEnoughAreMade) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.seconds = 1e9;
        settings.passes = 2;
        EXPECT_EQ(test::render_image(session, settings).report.passes, 2u);
        settings.passes.reset();
        settings.seconds = 0.5;
        EXPECT_GE(test::render_image(session, settings).report.passes, 1u);
    });
}

TEST_F(Passes, AnInterruptedOneLeavesTheMeanOfThoseBefore) {
    on_each_device([](Device& device) {
        const Scene scene = yard();
        Session session(device, scene);
        const RenderSettings settings = with_passes(test::few_vpls(), 4);
        const test::Rendering stopped = test::render_image(
            session, settings, [](const std::string&, double fraction) { return fraction < 0.25; });
        EXPECT_TRUE(stopped.report.interrupted);
        // When the second pass begins, unless this thread was late. One band is the whole picture here, and
        // the last pass has not finished it.
        const uint whole = stopped.report.passes - 1;
        ASSERT_LT(whole, 4u);
        EXPECT_EQ(stopped.image.values,
                  whole > 0 ? test::render_image(session, with_passes(settings, whole)).image.values
                            : std::vector<float>{});
    });
}

TEST(PassAverage, DividesEachRowByThePassesThatReachedIt) {
    PassAverage average(1, 3);
    std::vector<float> rows(3 * NEARLIGHT_LAYER_CHANNELS, 1.0f);
    average.add_rows(rows);
    average.begin_pass();
    std::ranges::fill(rows, 4.0f);
    average.add_rows(std::span(rows).first(NEARLIGHT_LAYER_CHANNELS));
    average.add_rows(std::span(rows).first(NEARLIGHT_LAYER_CHANNELS));
    std::vector<float> sent;
    average.send([&](std::span<const float> row) { sent.insert(sent.end(), row.begin(), row.end()); });
    ASSERT_EQ(sent.size(), rows.size());
    for (std::size_t i = 0; i < sent.size(); ++i) {
        EXPECT_EQ(sent[i], is_averaged(i) && i < 2 * NEARLIGHT_LAYER_CHANNELS ? 2.5f : 1.0f) << i;
    }
}

TEST(PassAverage, SendsNoRowThatNoPassReached) {
    PassAverage average(2, 3);
    average.add_rows(std::vector<float>(2 * NEARLIGHT_LAYER_CHANNELS, 1.0f));
    int rows = 0;
    average.send([&](std::span<const float>) { ++rows; });
    EXPECT_EQ(rows, 1);
}

}  // namespace
}  // namespace nearlight::core
