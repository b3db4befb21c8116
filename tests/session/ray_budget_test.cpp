// SPDX-License-Identifier: Apache-2.0
// What a pilot chooses gives about the least noise for its time.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "host/reference/test_rooms.h"
#include "host/scene/material_model.h"
#include "tests/session/corner_scene.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

constexpr float kPilotRange = 2.0f;
constexpr float kPilotStart = kPilotRange / 20;  // the radius that the pilot starts from
constexpr uint kNoiseSeeds = 16;

RenderSettings pilot_settings(std::optional<float> radius, uint vpl_count) {
    return {.view = {.range = kPilotRange, .clamp_radius = radius, .max_depth = 5},
            .sampling = {.vpl_count = vpl_count},
            .gather = {.samples_per_pixel = 4, .direct_samples_per_pixel = 64, .rays_per_pixel = 16},
            .seed = 7};
}

/// The variance of the indirect light of a picture over seeds, relative to its square, on the mean over
/// pixels and channels.
double radius_noise(Session& session, float radius, uint vpl_count) {
    const std::vector<Image> images =
        test::render_seeds(session, pilot_settings(radius, vpl_count), 100, kNoiseSeeds);
    const std::size_t first = static_cast<std::size_t>(images.front().find_channel("indirect.R"));
    const std::size_t channels = images.front().channels.size();
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = first; i < images.front().values.size(); i += channels) {
        double mean = 0.0;
        double squares = 0.0;
        for (const Image& image : images) {
            mean += image.values[i] / double{kNoiseSeeds};
            squares += image.values[i] * double{image.values[i]} / double{kNoiseSeeds};
        }
        if (mean > 0.0) {
            sum += (squares - mean * mean) / (mean * mean);
            ++count;
        }
    }
    return sum / static_cast<double>(count);
}

class RayBudgetTest : public test::DeviceTest {};

TEST_F(RayBudgetTest, TheChoiceIsAmongTheLeastNoisy) {
    const Scene scene = test::corner();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        for (const uint vpl_count : {60u, 1000u}) {
            const float chosen = test::render_image(session, pilot_settings(std::nullopt, vpl_count))
                                     .report.ray_budget.clamp_radius;
            std::map<float, double> noises;
            for (const float multiple : {0.25f, 0.5f, 1.0f, 2.0f, 4.0f}) {
                noises[multiple * kPilotStart] = radius_noise(session, multiple * kPilotStart, vpl_count);
            }
            const auto by_noise = [](const auto& a, const auto& b) { return a.second < b.second; };
            const auto [least, greatest] = std::minmax_element(noises.begin(), noises.end(), by_noise);
            ASSERT_TRUE(noises.contains(chosen)) << chosen;
            EXPECT_LT(noises.at(chosen), 1.4 * least->second)
                << vpl_count << " VPLs: chosen " << chosen << ", least noisy " << least->first;
            EXPECT_GT(greatest->second, 2 * least->second) << "no radius is wrong here";
        }
    });
}

TEST_F(RayBudgetTest, AGivenRadiusStays) {
    const Scene scene = test::corner();
    Session session(*devices().front(), scene);
    const RenderSettings settings = pilot_settings(0.07f, 60);
    const View view = session.look(settings.view, 1);
    const VplSet vpls = session.sample(view, settings.sampling, 1);
    EXPECT_EQ(budget_of(view, vpls, {}).clamp_radius, 0.07f);
}

/// The limit of what bundles share is a multiple of the mean radiance, in which single bright receivers do
/// not count.
TEST_F(RayBudgetTest, TheSharedLimitGoesByTheMeanLight) {
    on_each_device([](Device& device) {
        const auto limit_of = [&](const Scene& scene) {
            Session session(device, scene);
            return test::render_image(session, pilot_settings(std::nullopt, 1000))
                .report.ray_budget.shared_limit;
        };
        Scene scene = test::corner();
        const float limit = limit_of(scene);
        EXPECT_GT(limit, 0.0f);
        for (Material& material : scene.materials) {
            material.emission.value *= 2.0f;
        }
        EXPECT_NEAR(limit_of(scene), 2.0f * limit, 1e-3f * limit);
    });
}

/// The pilot gathers a part of a large set, whose VPLs stand for all, so that they bring as much light.
TEST_F(RayBudgetTest, APartOfALargeSetStandsForAllOfIt) {
    const Scene scene = test::corner();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        const auto budget_for = [&](uint vpl_count) {
            return test::render_image(session, pilot_settings(std::nullopt, vpl_count)).report.ray_budget;
        };
        const RayBudget of_few = budget_for(1500);
        const RayBudget of_many = budget_for(12000);  // every fifth or sixth of them is gathered
        EXPECT_NEAR(of_many.shared_limit, of_few.shared_limit, 0.05f * of_few.shared_limit);
        EXPECT_LE(of_many.clamp_radius, of_few.clamp_radius) << "more VPLs have less error";
    });
}

TEST_F(RayBudgetTest, WithoutCompensationTheRadiusIsATwentiethOfTheRange) {
    const Scene scene = test::corner();
    Session session(*devices().front(), scene);
    RenderSettings settings = pilot_settings(std::nullopt, 60);
    settings.gather.compensate = false;
    EXPECT_FLOAT_EQ(test::render_image(session, settings).report.ray_budget.clamp_radius, kPilotStart);
}

bool aims(Device& device, Scene scene) {
    small_scenes::set_camera(scene, {-1.5, 1, 0}, {0, 0, 0}, 60);
    Session session(device, scene);
    const View view = session.look(scene.camera, {.width = 64, .height = 64}, 3);
    return session.sample(view, {.vpl_count = 500}, 3).ray_budget.value().aimed_rays > 0;
}

TEST_F(RayBudgetTest, AimingPaysBesideAMirror) {
    on_each_device([](Device& device) { EXPECT_TRUE(aims(device, make_mirror_corner().scene)); });
}

TEST_F(RayBudgetTest, WithoutMirrorsNothingIsAimedAt) {
    on_each_device([](Device& device) {
        Scene scene = make_mirror_corner().scene;
        scene.materials[1] = small_scenes::lambertian({0.5f, 0.5f, 0.5f});
        EXPECT_FALSE(aims(device, scene));
    });
}

/// Where lamps are in every direction, all rays over a mirror meet one.
TEST_F(RayBudgetTest, AimingDoesNotPayWhereLampsFillTheView) {
    on_each_device([](Device& device) {
        Scene scene = make_mirror_corner().scene;
        Material lamp = small_scenes::lambertian({0, 0, 0});
        lamp.emission = parameter_of(1.0f);
        small_scenes::add_inward_sphere(scene, 50, 1, add_two_sided(scene, lamp));
        EXPECT_FALSE(aims(device, scene));
    });
}

}  // namespace
}  // namespace nearlight::core
