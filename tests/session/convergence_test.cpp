// SPDX-License-Identifier: Apache-2.0
// Every sampler with every policy has the expectation of the path tracer, pixel by pixel. The exception is
// the policy `paper` where it drops light, and the tests notice that. They also cover samplers and policies
// that are added to the tables.
#include "tests/session/convergence.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "host/reference/path_tracer.h"
#include "host/scene/scene_loader.h"
#include "tests/session/rendering.h"
#include "tests/session/variants.h"
#include "tests/support/device_fixture.h"
#include "tests/support/real_scenes.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::all_variants;
using test::judge_convergence;
using test::Variant;
using test::Verdict;

constexpr uint kSeeds = 16;

struct Case {
    Scene scene;
    float clamp_radius = 0.1f;
    std::optional<float> range{};
    uint max_depth = 6;
    uint vpl_count = 1000;
    int size = 32;  ///< width and height of the picture, pixels
    int spp = 512;  ///< samples per pixel of the path-traced picture
};

/// If rays of receivers compensate for the clamp radius, the picture that is right has none.
Image trace_truth(const Case& test_case, uint max_depth, bool compensate) {
    return trace_paths(test_case.scene, {.width = test_case.size,
                                         .height = test_case.size,
                                         .spp = test_case.spp,
                                         .max_depth = static_cast<int>(max_depth),
                                         .clamp_radius = compensate ? 0.0f : test_case.clamp_radius,
                                         .indirect_only = true,
                                         .pixel_centers = true,
                                         .seed = 17});
}

Verdict judge(Session& session, const Case& test_case, const Variant& variant, const Image& truth,
              uint max_depth, bool compensate, bool cuts = false) {
    const RenderSettings settings{
        .view = {.width = test_case.size,
                 .height = test_case.size,
                 .range = test_case.range,
                 .clamp_radius = test_case.clamp_radius,
                 .max_depth = max_depth},
        .sampling = {.sampler = variant.sampler,
                     .policy = variant.policy,
                     .vpl_count = test_case.vpl_count,
                     .cuts = cuts,
                     .set_count = 4 * test_case.vpl_count},
        .gather = {.samples_per_pixel = 1, .compensate = compensate, .indirect_only = true}};
    return judge_convergence(test::render_seeds(session, settings, 1000, kSeeds), truth, "indirect");
}

/// Rays of receivers do not depend on where a set comes from. So the sampler whose sets cost least stands for
/// all where rays compensate, besides the sampler whose VPLs are the receivers' own.
bool stands_for_all(const Variant& variant) {
    return variant.sampler == SamplerKind::instant_radiosity || variant.sampler == SamplerKind::local;
}

class Convergence : public test::DeviceTest {
  protected:
    using Choice = std::function<bool(const Variant&)>;

    /// All variants with a clamp radius, and those of `compensated` with rays that make up for it.
    void expect_all_converge(const Case& test_case, const Choice& compensated = stands_for_all) {
        expect_convergence(test_case, false, [](const Variant&) { return true; });
        expect_convergence(test_case, true, compensated);
    }
    void expect_convergence(const Case& test_case, bool compensate, const Choice& choice) {
        SCOPED_TRACE(compensate ? "compensated" : "clamped");
        const Image truth = trace_truth(test_case, test_case.max_depth, compensate);
        on_each_device([&](Device& device) {
            Session session(device, test_case.scene);
            for (const Variant& variant : all_variants()) {
                if (variant.policy != Policy::paper && choice(variant)) {
                    const Verdict verdict =
                        judge(session, test_case, variant, truth, test_case.max_depth, compensate);
                    EXPECT_TRUE(verdict.agrees) << variant.name() << ": " << verdict.reason;
                    EXPECT_LT(verdict.relative_error, 0.05)
                        << variant.name() << ": too noisy to tell anything";
                }
            }
        });
    }
    /// With cuts, a pixel asks about a quarter of the VPLs.
    void expect_cuts_converge(const Case& test_case) {
        const Image truth = trace_truth(test_case, test_case.max_depth, false);
        on_each_device([&](Device& device) {
            Session session(device, test_case.scene);
            for (const Variant& variant : all_variants()) {
                if (variant.policy != Policy::paper && variant.sampler != SamplerKind::local) {
                    const Verdict verdict =
                        judge(session, test_case, variant, truth, test_case.max_depth, false, true);
                    EXPECT_TRUE(verdict.agrees) << variant.name() << " with cuts: " << verdict.reason;
                    EXPECT_LT(verdict.relative_error, 0.05)
                        << variant.name() << " with cuts: too noisy to tell anything";
                }
            }
        });
    }
    /// The paper's policy keeps all light that has bounced once, and drops light that has bounced more often
    /// in the close range.
    void expect_paper_loses_bounces(const Case& test_case) {
        const Image one_bounce = trace_truth(test_case, 3, false);
        const Image truth = trace_truth(test_case, test_case.max_depth, false);
        on_each_device([&](Device& device) {
            Session session(device, test_case.scene);
            const Variant paper{SamplerKind::close_range, Policy::paper};
            const Verdict first = judge(session, test_case, paper, one_bounce, 3, false);
            EXPECT_TRUE(first.agrees) << first.reason;
            const Verdict all = judge(session, test_case, paper, truth, test_case.max_depth, false);
            EXPECT_FALSE(all.agrees);
            EXPECT_LT(all.bias, -5 * all.relative_error);
        });
    }
};

Case cornell_box() {
    return {.scene = load_scene(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "scenes/cornell-box/scene.xml"),
            .clamp_radius = 0.05f};  // the box is 0.55 m wide
}

Case furnace() {
    Case result{.scene = {}, .clamp_radius = 0.2f, .size = 16, .spp = 512};
    add_inward_sphere(result.scene, 1.0f, 1, add_material(result.scene, lambertian({0.6f, 0.5f, 0.4f})));
    add_point_light(result.scene, {0, 0, 0}, {2, 2, 2});
    set_camera(result.scene, {0, 0, 0}, {0.3, 0.2, 1}, 80);
    return result;
}

/// A court with a lamp on grounds that are ten times as wide, so that walks from the sky aim at it.
Scene court_on_wide_grounds() {
    Scene scene = court_under_sky();
    const uint grass = add_material(scene, lambertian({0.2f, 0.4f, 0.1f}));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{6, 5, 4});
    add_quad(scene, {-10, -1.01f, -10}, {0, 0, 20}, {20, 0, 0}, grass);
    add_quad(scene, {0.5f, 0.3f, 0.5f}, {0.3f, 0, 0}, {0, 0, 0.3f}, add_material(scene, lamp));
    return scene;
}

TEST_F(Convergence, CornellBox) {
    expect_all_converge(cornell_box(), [](const Variant&) { return true; });
}
TEST_F(Convergence, CornellBoxByThePaper) {
    expect_paper_loses_bounces(cornell_box());
}
TEST_F(Convergence, CornellBoxWithCuts) {
    expect_cuts_converge(cornell_box());
}
TEST_F(Convergence, Furnace) {
    expect_all_converge(furnace());
}
TEST_F(Convergence, CheckeredPlain) {
    expect_all_converge(
        {.scene = checkered_plain(), .clamp_radius = 0.2f, .range = 3.0f, .max_depth = 5, .vpl_count = 4000});
}
TEST_F(Convergence, CourtUnderSky) {
    expect_all_converge({.scene = court_under_sky(), .clamp_radius = 0.2f});
}
TEST_F(Convergence, CourtOnWideGrounds) {
    expect_all_converge(
        {.scene = court_on_wide_grounds(), .clamp_radius = 0.2f, .range = 3.0f, .vpl_count = 4000});
}
TEST_F(Convergence, Wall) {
    expect_all_converge({.scene = wall_view(), .clamp_radius = 0.2f, .size = 16});
}
TEST_F(Convergence, WholeRoom) {
    expect_all_converge({.scene = whole_room_view(), .clamp_radius = 0.3f, .size = 16});
}
TEST_F(Convergence, WholeRoomWithCuts) {
    expect_cuts_converge({.scene = whole_room_view(), .clamp_radius = 0.3f, .size = 16});
}
TEST_F(Convergence, NextRoom) {
    expect_all_converge(
        {.scene = next_room_view(), .clamp_radius = 0.3f, .vpl_count = 3000, .size = 16, .spp = 4096});
}
TEST_F(Convergence, VeachBidir) {
    const auto file = test::real_scene("veach-bidir/scene.xml");
    if (file.empty()) {
        GTEST_SKIP() << "veach-bidir is not there; set NEARLIGHT_TEST_SCENES";
    }
    expect_all_converge({.scene = load_scene(file),
                         .clamp_radius = 1.0f,
                         .size = 16,
                         .spp = 4096});  // the room is 13 units long
}

}  // namespace
}  // namespace nearlight::core
