// SPDX-License-Identifier: Apache-2.0
// Pictures whose samples ask about strata of the VPLs: what they must converge to, and what they gain.
#include <gtest/gtest.h>

#include <cmath>

#include "host/scene/material_model.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"
#include "tests/support/spread.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

/// A floor, a wall and a small block with sharp edges under a lamp.
Scene court() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.7f, 0.6f, 0.5f}));
    const uint dark = add_material(scene, lambertian({0.1f, 0.2f, 0.3f}));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{5, 5, 6});
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, grey);
    add_quad(scene, {-2, -1, 1}, {0, 2, 0}, {4, 0, 0}, grey);
    add_quad(scene, {-0.4f, -0.6f, 0}, {0, 0, 0.5f}, {0.7f, 0, 0.2f}, dark);
    add_quad(scene, {-0.4f, -1, 0}, {0, 0.4f, 0}, {0.7f, 0, 0.2f}, dark);
    add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, lamp));
    set_camera(scene, {0.1, 0.6, -1.9}, {0, -0.5, 1}, 70);
    scene.camera.width = 40;
    scene.camera.height = 24;
    return scene;
}

double picture_mean(const Image& image) {
    double sum = 0;
    for (std::size_t i = NEARLIGHT_LAYER_BEAUTY + 1; i < image.values.size(); i += NEARLIGHT_LAYER_CHANNELS) {
        sum += image.values[i];
    }
    return sum / image.width / image.height;
}

class Strata : public test::DeviceTest {};

// A picture with strata has the same VPLs and the same samples as one without, so they differ only by which
// sample asks about which VPLs.
TEST_F(Strata, KeepEverySamplersExpectation) {
    const Scene scene = court();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        for (const SamplerEntry& sampler : all_samplers()) {
            for (const PolicyEntry& policy : all_policies()) {
                if (sampler.kind != SamplerKind::close_range && policy.policy != Policy::complete) {
                    continue;
                }
                std::vector<double> differences;
                double mean = 0;
                for (uint seed = 1; seed <= 8; ++seed) {
                    RenderSettings settings{
                        .sampling = {.sampler = sampler.kind, .policy = policy.policy, .vpl_count = 120},
                        .gather = {.samples_per_pixel = 4, .strata = 1, .direct_samples_per_pixel = 8},
                        .seed = seed};
                    const double whole = picture_mean(test::render_image(session, settings).image);
                    settings.gather.strata = 4;
                    differences.push_back(picture_mean(test::render_image(session, settings).image) - whole);
                    mean += whole / 8;
                }
                const test::Spread spread = test::spread_of(differences);
                EXPECT_LT(std::abs(spread.mean), 5.4 * spread.error + 1e-6 * mean)  // 7 degrees, 1e-3
                    << sampler.name << ", " << policy.name;
                EXPECT_LT(spread.error, 0.01 * mean) << sampler.name << ": too noisy to tell";
                EXPECT_GT(spread.error, 0.0) << sampler.name << " does not use strata";
            }
        }
    });
}

// Strata decide which receivers stand together, but no layer without VPLs may show it.
TEST_F(Strata, DoNotChangeALayerWithoutVpls) {
    const Scene scene = court();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        RenderSettings settings{.sampling = {.vpl_count = 60},
                                .gather = {.samples_per_pixel = 8, .strata = 1}};
        const Image whole = test::render_image(session, settings).image;
        for (const uint strata : {2u, 4u, 8u}) {
            settings.gather.strata = strata;
            const Image image = test::render_image(session, settings).image;
            ASSERT_EQ(image.values.size(), whole.values.size());
            std::size_t different = 0;
            for (std::size_t i = 0; i < whole.values.size(); ++i) {
                const std::size_t layer = i % NEARLIGHT_LAYER_CHANNELS;
                const bool has_vpls =
                    layer < NEARLIGHT_LAYER_DIRECT || layer >= NEARLIGHT_LAYER_VARIANCE ||
                    (layer >= NEARLIGHT_LAYER_INDIRECT && layer < NEARLIGHT_LAYER_INDIRECT + 3);
                different += !has_vpls && image.values[i] != whole.values[i] ? 1 : 0;
            }
            EXPECT_EQ(different, 0u) << strata << " strata";
        }
    });
}

/// The variance over `count` seeds, as a mean over pixels.
double variance_over_seeds(Session& session, const RenderSettings& settings, uint count) {
    const std::vector<Image> images = test::render_seeds(session, settings, 1, count);
    double total = 0;
    for (std::size_t i = NEARLIGHT_LAYER_BEAUTY + 1; i < images[0].values.size();
         i += NEARLIGHT_LAYER_CHANNELS) {
        std::vector<double> values;
        for (const Image& image : images) {
            values.push_back(image.values[i]);
        }
        const double error = test::spread_of(values).error;
        total += error * error * count;
    }
    return total / images[0].width / images[0].height;
}

// Sixteen samples of a sixteenth of the VPLs trace a quarter of the shadow rays of four samples of all. The
// remainder is left out, because its rays know nothing of strata.
TEST_F(Strata, GiveLessNoiseForFewerRays) {
    const Scene scene = court();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        RenderSettings settings{.sampling = {.vpl_count = 800},
                                .gather = {.samples_per_pixel = 4, .strata = 1, .compensate = false}};
        const double before = variance_over_seeds(session, settings, 8);
        settings.gather.samples_per_pixel = 16;
        settings.gather.strata.reset();
        const double with_strata = variance_over_seeds(session, settings, 8);
        settings.gather.strata = 1;
        const double without = variance_over_seeds(session, settings, 8);
        RecordProperty("ratio", std::to_string(with_strata / before));
        EXPECT_LT(with_strata, 0.7 * before);
        EXPECT_LT(with_strata, 1.5 * without);
    });
}

}  // namespace
}  // namespace nearlight::core
