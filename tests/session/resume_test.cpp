// SPDX-License-Identifier: Apache-2.0
// Renders that go on from a checkpoint, and passes that are made apart.
#include <gtest/gtest.h>

#include "tests/session/rendering.h"
#include "tests/session/yard_scene.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using Moment = PassesSoFar::Moment;

class Resume : public test::DeviceTest {};

/// In a picture of several bands.
/// Samples count in neighbouring rows, too, where a pass has enough of them.
Scene tall_yard() {
    Scene scene = test::yard({70, 600, 20});
    scene.camera.filter = default_filter(FilterKind::gaussian);
    return scene;
}

test::Rendering render_from(Session& session, const RenderSettings& settings, PassStart start,
                            const PassWatcher& watcher = {}) {
    return test::render_image(session, settings, {.watcher = watcher}, std::move(start));
}

struct Watched {
    test::Rendering rendering;
    std::vector<Moment> moments;
    std::vector<Checkpoint> checkpoints;
};

/// Renders, and keeps all checkpoints on the way.
Watched watch(Session& session, const RenderSettings& settings, PassStart start = {}) {
    Watched watched;
    watched.rendering = render_from(session, settings, std::move(start), [&](const PassesSoFar& so_far) {
        watched.moments.push_back(so_far.moment);
        watched.checkpoints.push_back({so_far.record(), so_far.average.sums()});
    });
    return watched;
}

void expect_same(const test::Rendering& a, const test::Rendering& b) {
    EXPECT_EQ(a.report.image_hash, b.report.image_hash);
    EXPECT_EQ(a.image.values, b.image.values);
    EXPECT_EQ(a.report.pass_samples, b.report.pass_samples);
    EXPECT_EQ(a.report.passes, b.report.passes);
    EXPECT_EQ(a.report.range, b.report.range);
    EXPECT_EQ(a.report.ray_budget, b.report.ray_budget);
    EXPECT_EQ(a.report.max_depth, b.report.max_depth);
    EXPECT_EQ(a.report.totals.close_vpls + a.report.totals.distant_vpls,
              b.report.totals.close_vpls + b.report.totals.distant_vpls);
    EXPECT_EQ(a.report.error, b.report.error);
}

/// Settings that bundle receivers, choose VPLs and end passes in different ways.
std::vector<RenderSettings> ways_to_render() {
    RenderSettings plain = test::few_vpls();
    plain.passes = 3;
    std::vector<RenderSettings> ways(5, plain);
    ways[1].sampling.sampler = SamplerKind::local;
    ways[2].gather.interleave = 4;
    ways[2].gather.samples_per_pixel = 1;
    ways[3].passes.reset();
    ways[3].error = 0.05;
    ways[4].passes.reset();
    ways[4].pass_samples = {2, 4, 3};
    ways[4].gather.window = PixelWindow{5, 37, 60, 300};
    return ways;
}

TEST_F(Resume, FromAnyMomentGivesTheBitsOfAnUninterruptedRender) {
    const Scene scene = tall_yard();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        for (const RenderSettings& settings : ways_to_render()) {
            const Watched whole = watch(session, settings);
            EXPECT_EQ(std::ranges::count(whole.moments, Moment::between_passes),
                      whole.rendering.report.passes);
            EXPECT_GT(std::ranges::count(whole.moments, Moment::within_pass), 0);
            for (const Checkpoint& checkpoint : whole.checkpoints) {
                expect_same(render_from(session, settings, {.checkpoint = checkpoint}), whole.rendering);
            }
        }
    });
}

TEST_F(Resume, AFinishedPictureTakesMorePasses) {
    const Scene scene = tall_yard();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.passes = 3;
        const test::Rendering three = test::render_image(session, settings);
        settings.passes = 1;
        const Watched one = watch(session, settings, {.keeps_sums = true});
        ASSERT_FALSE(one.checkpoints.empty());
        EXPECT_EQ(one.rendering.image.values, test::render_image(session, settings).image.values);
        settings.passes = 3;
        expect_same(render_from(session, settings, {.checkpoint = one.checkpoints.back()}), three);
    });
}

TEST_F(Resume, PassesMadeApartAddUpToThoseOfOneRender) {
    const Scene scene = tall_yard();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.passes = 5;
        const Watched whole = watch(session, settings);
        settings.passes = 2;
        const Watched first = watch(session, settings);
        settings.passes = 3;
        const Watched rest = watch(session, settings, {.first = 2});
        PassSums sums = rest.checkpoints.back().sums;
        sums.add(first.checkpoints.back().sums);
        EXPECT_TRUE(std::ranges::equal(sums.sums(), whole.checkpoints.back().sums.sums()));
        EXPECT_EQ(rest.checkpoints.back().record.choice, whole.checkpoints.back().record.choice);
        EXPECT_EQ(rest.checkpoints.back().record.whole.front().first, 2u);
        // A part goes on as a whole does.
        for (const Checkpoint& checkpoint : rest.checkpoints) {
            expect_same(render_from(session, settings, {.first = 2, .checkpoint = checkpoint}),
                        rest.rendering);
        }
    });
}

TEST_F(Resume, AnInterruptedRenderGoesOnFromItsLastRow) {
    const Scene scene = tall_yard();
    on_each_device([&](Device& device) {
        Session session(device, scene);
        RenderSettings settings = test::few_vpls();
        settings.passes = 2;
        std::optional<Checkpoint> last;
        bool is_stopped = false;
        RenderHooks hooks{.progress = [&](double) { return !is_stopped; }};
        hooks.watcher = [&](const PassesSoFar& so_far) {
            is_stopped = true;
            last = Checkpoint{so_far.record(), so_far.average.sums()};
        };
        const RenderReport stopped = render(session, settings, hooks);
        ASSERT_TRUE(stopped.interrupted);
        EXPECT_GT(last->record.begun_rows, 0u);
        EXPECT_TRUE(last->record.whole.front().samples.empty());
        expect_same(render_from(session, settings, {.checkpoint = last}),
                    test::render_image(session, settings));
    });
}

}  // namespace
}  // namespace nearlight::core
