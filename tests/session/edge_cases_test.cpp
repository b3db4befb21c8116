// SPDX-License-Identifier: Apache-2.0
// Samplers in extreme cases: tiny budgets, an empty view, no light, and scenes far wider than what is seen.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "host/base/message.h"
#include "tests/session/rendering.h"
#include "tests/support/device_fixture.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

constexpr std::array kSamplers{SamplerKind::bidirectional, SamplerKind::local};

/// A floor and two walls under a lamp, seen from inside.
Scene niche() {
    Scene scene;
    const uint grey = add_material(scene, lambertian({0.6f, 0.5f, 0.4f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, grey);
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, grey);
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, grey);
    add_point_light(scene, {-0.2f, 0.6f, 0.3f}, {1, 1, 1});
    set_camera(scene, {-0.6, 0.2, -0.9}, {0.4, -0.4, 1}, 70);
    scene.camera.width = 24;
    scene.camera.height = 24;
    return scene;
}

RenderSettings settings_of(SamplerKind sampler, uint vpl_count, uint seed) {
    return {.view = {.range = 2.5f, .clamp_radius = 0.2f, .max_depth = 5},
            .sampling = {.sampler = sampler, .vpl_count = vpl_count},
            .gather = {.samples_per_pixel = 1},
            .seed = seed};
}

double indirect_mean(const Image& image) {
    for (const float value : image.values) {
        EXPECT_TRUE(std::isfinite(value));
    }
    return channel_mean(image, "indirect.G");
}

class EdgeCases : public test::DeviceTest {};

TEST_F(EdgeCases, AWidthThatCostsLightIsToldOnce) {
    on_each_device([](Device& device) {
        Scene scene = niche();
        const auto warnings = [&] {
            int count = 0;
            set_message_sink([&](MessageLevel level, std::string_view text) {
                count += level == MessageLevel::warning && text.find("m wide") != std::string_view::npos;
            });
            Session session(device, scene);
            for (uint seed = 0; seed < 3; ++seed) {
                static_cast<void>(session.look({.width = 8, .height = 8}, seed));
            }
            set_message_sink({});
            return count;
        };
        EXPECT_EQ(warnings(), 0);
        add_quad(scene, {-5e4f, -2, -5e4f}, {0, 0, 1e5f}, {1e5f, 0, 0}, 0);
        EXPECT_EQ(warnings(), 1);
    });
}

/// A floor below a roof of a millimetre, in a dome of the given radius (m) that shines.
Scene shelter_in_dome(float radius) {
    Scene scene;
    const uint white = add_two_sided(scene, lambertian({0.7f, 0.7f, 0.7f}));
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, white);
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
    add_quad(scene, {-1, 1.001f, -1}, {0, 0, 2}, {2, 0, 0}, white);
    Material shining = lambertian({0, 0, 0});
    shining.emission = parameter_of(Vec3{1, 1, 1});
    add_inward_sphere(scene, radius, 2, add_material(scene, shining));
    set_camera(scene, {0, 0.4, 1.8}, {0, 0.6, 0}, 60);
    scene.camera.width = 16;
    scene.camera.height = 12;
    return scene;
}

/// Where rays start is decided by what they leave, not by how wide the scene is.
TEST_F(EdgeCases, AWideSurroundingChangesNothing) {
    on_each_device([](Device& device) {
        const auto mean_within = [&](float radius, SamplerKind sampler) {
            const Scene scene = shelter_in_dome(radius);
            Session session(device, scene);
            double sum = 0;
            for (uint seed = 0; seed < 6; ++seed) {
                sum += indirect_mean(test::render_image(session, settings_of(sampler, 300, seed)).image);
            }
            return sum / 6;
        };
        for (const SamplerKind sampler :
             {SamplerKind::close_range, SamplerKind::bidirectional, SamplerKind::local}) {
            const double near = mean_within(10, sampler);
            EXPECT_NEAR(mean_within(1000, sampler), near, 0.03 * near) << to_string(sampler);
        }
    });
}

/// A budget too small for a good picture is kept, and still gives the right picture on average.
TEST_F(EdgeCases, TinyBudgetsAreKeptAndRightOnAverage) {
    on_each_device([](Device& device) {
        const Scene scene = niche();
        Session session(device, scene);
        const auto mean_of = [&](SamplerKind sampler, uint budget, int seeds, std::size_t& most) {
            double sum = 0;
            for (int seed = 0; seed < seeds; ++seed) {
                const auto [image, report] =
                    test::render_image(session, settings_of(sampler, budget, 50u + seed));
                sum += indirect_mean(image);
                most = std::max(most, report.totals.close_vpls + report.totals.distant_vpls);
            }
            return sum / seeds;
        };
        std::size_t ignored = 0;
        const double expected = mean_of(SamplerKind::instant_radiosity, 20'000, 2, ignored);
        for (const SamplerKind sampler : kSamplers) {
            for (const uint budget : {1u, 2u, 63u}) {
                std::size_t most = 0;
                const double found = mean_of(sampler, budget, budget > 2 ? 40 : 200, most);
                EXPECT_NEAR(found, expected, 0.1 * expected) << to_string(sampler) << ", " << budget;
                EXPECT_LE(most, sampler == SamplerKind::bidirectional ? budget + 1 : 4 * budget + 16)
                    << to_string(sampler) << ", " << budget;
            }
        }
    });
}

TEST_F(EdgeCases, ACameraThatSeesNothingGivesABlackPicture) {
    on_each_device([](Device& device) {
        Scene scene = niche();
        set_camera(scene, {0, 0, -5}, {0, 0, -6}, 70);
        for (const SamplerKind sampler : kSamplers) {
            EXPECT_EQ(indirect_mean(test::render_image(device, scene, settings_of(sampler, 50, 1)).image),
                      0.0)
                << to_string(sampler);
        }
    });
}

TEST_F(EdgeCases, WithoutLightThereIsNone) {
    on_each_device([](Device& device) {
        Scene scene = niche();
        scene.delta_emitters.clear();
        for (const SamplerKind sampler : kSamplers) {
            const auto [image, report] = test::render_image(device, scene, settings_of(sampler, 50, 1));
            EXPECT_EQ(indirect_mean(image), 0.0) << to_string(sampler);
            EXPECT_EQ(report.totals.distant_vpls, 0u);
        }
    });
}

/// The lamp lights nothing, so walks leave the scene and reverse VPLs are dark.
TEST_F(EdgeCases, ALightThatShinesPastTheSceneGivesNone) {
    on_each_device([](Device& device) {
        Scene scene = niche();
        scene.delta_emitters[0].position = {3, 0, 3};  // behind both walls, which face inwards
        for (const SamplerKind sampler : kSamplers) {
            EXPECT_EQ(indirect_mean(test::render_image(device, scene, settings_of(sampler, 50, 1)).image),
                      0.0)
                << to_string(sampler);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
