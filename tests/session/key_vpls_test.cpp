// SPDX-License-Identifier: Apache-2.0
#include "host/session/key_vpls.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/session/rendering.h"
#include "tests/session/yard_scene.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using test::few_vpls;

class KeyVplsTest : public test::DeviceTest {
  protected:
    /// The yard's camera, moved to the right.
    static SceneCamera camera_at(double x) {
        Scene scene;
        small_scenes::set_camera(scene, {0.1 + x, 0.6, -1.9}, {x, -0.5, 1}, 70);
        scene.camera.width = 40;
        scene.camera.height = 24;
        return scene.camera;
    }
    static bool same_bits(const VplSet& a, const VplSet& b) {
        const std::vector<Vpl> first = a.vpls.download();
        const std::vector<Vpl> second = b.vpls.download();
        return std::ranges::equal(std::as_bytes(std::span(first)), std::as_bytes(std::span(second)));
    }

    const Scene scene_ = test::yard({40, 24, 70});
};

TEST_F(KeyVplsTest, JoinedSetsBringTheMeanOfWhatEachBrings) {
    on_each_device([&](Device& device) {
        Session session(device, scene_);
        const View view = session.look({.range = 2.0f, .clamp_radius = 0.2f}, 1);
        const VplSet a = session.sample(view, few_vpls().sampling, 1);
        const VplSet b = session.sample(view, few_vpls().sampling, 2);
        const VplSet both = session.join(std::vector<VplPart>{{&a, 0.25f}, {&b, 0.75f}});
        EXPECT_EQ(both.vpls.count(), a.vpls.count() + b.vpls.count());
        EXPECT_EQ(both.close_count, a.close_count + b.close_count);
        const std::vector<Vec3> points{{0, -1, 0}, {1, -1, -1}, {0.5f, 0, 1}};
        const std::vector<Vec3> normals{{0, 1, 0}, {0, 1, 0}, {0, 0, -1}};
        const auto irradiance = [&](const VplSet& set) {
            return session.irradiance(points, normals, view, set, {.direct_samples = 4, .paths = 0}, 3);
        };
        const std::vector<Vec3> of_a = irradiance(a);
        const std::vector<Vec3> of_b = irradiance(b);
        const std::vector<Vec3> of_both = irradiance(both);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_GT(std::abs(of_a[i].x - of_b[i].x), 1e-4f * of_a[i].x);
            EXPECT_NEAR(of_both[i].x, 0.25f * of_a[i].x + 0.75f * of_b[i].x, 1e-5f * of_both[i].x);
        }
    });
}

TEST_F(KeyVplsTest, OneSetStaysAsItIs) {
    on_each_device([&](Device& device) {
        Session session(device, scene_);
        const VplSet set = session.sample(session.look({}, 1), few_vpls().sampling, 1);
        const VplSet joined = session.join(std::vector<VplPart>{{&set, 1.0f}});
        EXPECT_TRUE(same_bits(set, joined));
        EXPECT_EQ(set.ray_budget, joined.ray_budget);
        EXPECT_EQ(set.close_fraction, joined.close_fraction);
    });
}

TEST_F(KeyVplsTest, NoVplsAreNone) {
    on_each_device([&](Device& device) {
        Session session(device, scene_);
        const VplSet none = session.sample(session.look({}, 1), {.vpl_count = 0}, 1);
        EXPECT_TRUE(session.join(std::vector<VplPart>{{&none, 0.5f}, {&none, 0.5f}}).vpls.empty());
    });
}

TEST_F(KeyVplsTest, RaysBeginWhereTheyDoOnAverage) {
    VplSet a;
    VplSet b;
    a.ray_budget = RayBudget{.clamp_radius = 1.0f, .direct_samples_per_pixel = 16, .shared_limit = 9.0f};
    b.ray_budget = RayBudget{.clamp_radius = 2.0f, .direct_samples_per_pixel = 64, .shared_limit = 8.0f};
    const std::vector<VplPart> parts{{&a, 0.75f}, {&b, 0.25f}};
    const JoinedVpls both = join_on_host(parts);
    ASSERT_TRUE(both.set.ray_budget.has_value());
    EXPECT_FLOAT_EQ(both.set.ray_budget->clamp_radius, 1.25f);
    EXPECT_EQ(both.set.ray_budget->direct_samples_per_pixel, 64u);
    EXPECT_EQ(both.set.ray_budget->shared_limit, 8.0f);
    b.ray_budget.reset();
    EXPECT_FALSE(join_on_host(parts).set.ray_budget.has_value());
}

TEST_F(KeyVplsTest, DependOnTheirKeyViewsOnly) {
    on_each_device([&](Device& device) {
        Session session(device, scene_);
        const SamplingSettings sampling = few_vpls().sampling;
        const auto views = [](float weight) {
            return std::vector<KeyView>{{.frame = 0, .camera = camera_at(0), .weight = 1 - weight},
                                        {.frame = 24, .camera = camera_at(0.5), .weight = weight}};
        };
        KeyVpls walk({});
        walk.set_views({{.frame = 0, .camera = camera_at(0)}});
        const VplSet begin = walk.make(session, {}, sampling, 5);
        EXPECT_TRUE(same_bits(begin, session.sample(session.look(camera_at(0), {}, 5), sampling, 5)));
        walk.set_views(views(0.25f));
        const VplSet later = walk.make(session, {}, sampling, 5);
        KeyVpls alone({});
        alone.set_views(views(0.25f));
        EXPECT_TRUE(same_bits(later, alone.make(session, {}, sampling, 5)));
        // The same VPLs with other weights.
        alone.set_views(views(0.5f));
        const std::vector<Vpl> middle = alone.make(session, {}, sampling, 5).vpls.download();
        const std::vector<Vpl> before = later.vpls.download();
        ASSERT_EQ(middle.size(), before.size());
        for (std::size_t i = 0; i < middle.size(); ++i) {
            EXPECT_EQ(middle[i].position, before[i].position);
        }
    });
}

TEST_F(KeyVplsTest, MakeThePictureOfAnySampler) {
    on_each_device([&](Device& device) {
        Session session(device, scene_);
        for (const SamplerKind sampler : {SamplerKind::close_range, SamplerKind::instant_radiosity}) {
            const RenderSettings settings = few_vpls(sampler);
            const test::Rendering plain = test::render_image(session, settings);
            KeyVpls vpls(settings.view);
            vpls.set_views({{.frame = 3, .camera = scene_.camera}});
            std::vector<float> pixels;
            RenderHooks hooks;
            hooks.rows = [&](std::span<const float> rows) {
                pixels.insert(pixels.end(), rows.begin(), rows.end());
            };
            hooks.vpls = [&](const ViewSettings& view, const SamplingSettings& sampling, uint seed) {
                return vpls.make(session, view, sampling, seed);
            };
            const RenderReport report = render(session, settings, hooks);
            EXPECT_EQ(report.image_hash, plain.report.image_hash);
            EXPECT_EQ(pixels, plain.image.values);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
