// SPDX-License-Identifier: Apache-2.0
// The whole comparison on a small room: which cells it measures, which it reuses, and which input it refuses.
#include "host/compare/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/base/hash.h"
#include "host/image/image_io.h"
#include "host/reference/path_tracer.h"
#include "tests/compare/methods.h"
#include "tests/image/temporary_folder.h"
#include "tests/support/device_fixture.h"
#include "tests/support/error_matchers.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::error_of;
using test::mentions;

/// A floor and two walls with a point light between them.
Scene corner() {
    Scene scene;
    scene.name = "corner";
    const uint white = add_material(scene, lambertian({0.7f, 0.6f, 0.5f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);  // floor
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);   // back
    add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, white);  // side
    set_camera(scene, {0.3, 0.2, -2.0}, {-0.1, -0.4, 1}, 60);
    add_point_light(scene, {0.3f, 0.5f, -0.2f}, {1.0f, 0.9f, 0.8f});
    return scene;
}

/// An observer that stops after a number of cells.
struct Stopper {
    std::size_t cells_left = 1000;
    bool measuring = false;

    CompareObserver observer() {
        return {.begin = [this](const std::string& step) { measuring = step.ends_with("measuring"); },
                .advance = [](double, std::optional<double>) {},
                .stopped = [this] { return measuring && cells_left-- == 0; }};
    }
};

class ComparisonTest : public test::DeviceTest {
  protected:
    CompareSettings settings(const std::string& folder = "report") const {
        CompareSettings settings;
        settings.output = folder_ / folder;
        settings.reference_folder = folder_ / "references";
        settings.methods = {default_method(), kWalks};
        settings.vpl_counts = {20, 80};
        settings.seed_count = 2;
        settings.width = 16;
        settings.height = 12;
        settings.reference_spp = 64;
        settings.program_version = "test";
        return settings;
    }
    static std::optional<Comparison> run(Device& device, const Scene& scene, const CompareSettings& settings,
                                         std::size_t stop_after = 1000) {
        check_settings(settings);
        Stopper stopper{stop_after};
        return compare(device, std::span(&scene, 1), settings, stopper.observer());
    }

    TemporaryFolder folder_;
};

TEST_F(ComparisonTest, GoesOnWhereItStopped) {
    on_each_device([&](Device& device) {
        const Scene scene = corner();
        EXPECT_FALSE(run(device, scene, settings("resumed"), 1));
        const auto resumed = run(device, scene, settings("resumed"));
        const auto whole = run(device, scene, settings("whole"));
        ASSERT_TRUE(resumed && whole);
        EXPECT_EQ(resumed->measured_cells, 7u);
        EXPECT_EQ(resumed->reused_cells, 1u);
        EXPECT_EQ(whole->measured_cells, 8u);
        const auto& a = resumed->scenes[0].equal_vpls;
        const auto& b = whole->scenes[0].equal_vpls;
        ASSERT_EQ(a.size(), 4u);
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_EQ(a[i].rmse.value, b[i].rmse.value);
            EXPECT_EQ(a[i].mean_ratio.mean, b[i].mean_ratio.mean);
            EXPECT_EQ(a[i].flip.mean, b[i].flip.mean);
            EXPECT_EQ(a[i].gathered_vpls, b[i].gathered_vpls);
        }
        for (const char* name : {"resumed", "whole"}) {
            std::filesystem::remove_all(folder_ / name);
        }
    });
}

TEST_F(ComparisonTest, MeasuresOnlyWhatIsNew) {
    on_each_device([&](Device& device) {
        CompareSettings more = settings();
        ASSERT_TRUE(run(device, corner(), more));
        more.seed_count = 3;
        more.vpl_counts = {20, 40, 80};
        const auto second = run(device, corner(), more);
        EXPECT_EQ(second->reused_cells, 8u);
        EXPECT_EQ(second->measured_cells, 10u);
        EXPECT_EQ(second->scenes[0].reference.seconds, 0.0);
        more.max_depth = 4;  // the light and the reference differ, so nothing is reused
        EXPECT_EQ(run(device, corner(), more)->reused_cells, 0u);
        std::filesystem::remove_all(more.output);
    });
}

TEST_F(ComparisonTest, ErrorsFallWithTheCountAndNoLightIsLost) {
    on_each_device([&](Device& device) {
        CompareSettings wide = settings("wide");
        wide.vpl_counts = {20, 1000};
        wide.seed_count = 6;
        wide.reference_spp = 1024;
        const auto comparison = run(device, corner(), wide);
        const auto& rows = comparison->scenes[0].equal_vpls;
        for (std::size_t method = 0; method < 2; ++method) {
            EXPECT_LT(rows[2 + method].rmse.value, 0.5 * rows[method].rmse.value)
                << to_string(rows[method].method);
            const Interval& ratio = rows[2 + method].mean_ratio;
            EXPECT_NEAR(ratio.mean, 1.0, 3.0 * ratio.half_width + 0.01);
        }
        EXPECT_EQ(comparison->scenes[0].equal_rmse.size(), 2u);
        std::filesystem::remove_all(wide.output);
    });
}

TEST_F(ComparisonTest, MakesItsPictures) {
    on_each_device([&](Device& device) {
        const auto comparison = run(device, corner(), settings());
        const SceneFigures& figures = comparison->scenes[0].figures;
        EXPECT_EQ(figures.methods.size(), 4u);
        EXPECT_EQ(figures.vpls.size(), 2u);
        EXPECT_EQ(figures.crops.size(), 2u);
        EXPECT_GT(figures.vpls[0].visible, 0u);
        for (const MethodFigure& figure : figures.methods) {
            EXPECT_EQ(read_image(figure.picture.full).width, 16);
            EXPECT_EQ(read_image(figure.error_map.full).height, 12);
            EXPECT_EQ(figure.crop_rmse.size(), 2u);
            EXPECT_GT(figure.crop_rmse[0], 0.0);
        }
        std::filesystem::remove_all(folder_ / "report");
    });
}

TEST_F(ComparisonTest, TakesAReferenceThatFitsAndRefusesOthers) {
    on_each_device([&](Device& device) {
        const Scene scene = corner();
        const std::filesystem::path file = folder_ / "truth.exr";
        const auto write = [&](int width, std::uint64_t hash) {
            const Image image = trace_paths(scene, {.width = width,
                                                    .height = 12,
                                                    .spp = 16,
                                                    .max_depth = kUnlimitedPathDepth,
                                                    .clamp_radius = 0.1f,
                                                    .pixel_centers = true});
            write_image(file, image,
                        {.metadata = {{"nearlight:sceneHash", hex_digits(hash)},
                                      {"nearlight:clampRadius", 0.1f},
                                      {"nearlight:maxDepth", kUnlimitedPathDepth},
                                      {"nearlight:samplesPerPixel", 16},
                                      {"nearlight:pixelCenters", 1},
                                      {"nearlight:complete", 1}}});
        };
        CompareSettings given = settings("given");
        given.reference_files = {file};
        write(16, scene_hash(scene));
        const auto comparison = run(device, scene, given);  // the comparison uses the file's clamp radius
        EXPECT_EQ(comparison->scenes[0].facts.clamp_radius, 0.1f);
        EXPECT_EQ(comparison->scenes[0].reference.file, file.string());
        const auto refused = [&](const std::string& because) {
            const Error error = error_of([&] { run(device, scene, given); });
            EXPECT_EQ(error.kind(), ErrorKind::file);
            EXPECT_TRUE(mentions(error, because));
        };
        given.clamp_radius = 0.2f;
        refused("clamp radius");
        given.clamp_radius.reset();
        given.max_depth = 5;
        refused("depth");
        given.max_depth.reset();
        write(20, scene_hash(scene));
        refused("20x12");
        write(16, scene_hash(scene) + 1);
        refused("none of the scenes");
        write(16, scene_hash(scene));
        const std::filesystem::path twin = folder_ / "twin.exr";
        std::filesystem::copy_file(file, twin, std::filesystem::copy_options::overwrite_existing);
        given.reference_files = {file, twin};
        refused("twin.exr' shows a scene that another reference shows too");
        std::filesystem::remove_all(given.output);
    });
}

TEST_F(ComparisonTest, ASceneWithNothingToCompareIsRefused) {
    on_each_device([&](Device& device) {
        Scene dark = corner();
        dark.delta_emitters.clear();
        EXPECT_TRUE(mentions(error_of([&] { run(device, dark, settings()); }), "emits light"));
        Scene away = corner();
        set_camera(away, {0.3, 0.2, -2.0}, {0.3, 0.2, -9.0}, 60);
        EXPECT_TRUE(mentions(error_of([&] { run(device, away, settings()); }), "sees no diffuse surface"));
        Scene black = corner();
        black.materials[0] = lambertian({0, 0, 0});
        EXPECT_TRUE(mentions(error_of([&] { run(device, black, settings()); }), "nothing to compare"));
        Scene direct = corner();
        direct.max_depth = 2;
        EXPECT_EQ(error_of([&] { run(device, direct, settings()); }).setting(), "max_depth");
    });
}

/// A floor alone gets no light from other surfaces; of the others one is dark, and one is out of view.
TEST_F(ComparisonTest, ScenesWithNothingToCompareAreLeftOutAmongOthers) {
    on_each_device([&](Device& device) {
        std::vector<Scene> scenes(4, corner());
        scenes[0].name = "floor";
        scenes[0].triangles.resize(2);
        scenes[2].delta_emitters.clear();
        set_camera(scenes[3], {0.3, 0.2, -2.0}, {0.3, 0.2, -9.0}, 60);
        Stopper stopper;
        const std::optional<Comparison> comparison = compare(device, scenes, settings(), stopper.observer());
        ASSERT_TRUE(comparison);
        ASSERT_EQ(comparison->scenes.size(), 1u);
        EXPECT_EQ(comparison->scenes[0].facts.name, "corner");
        scenes.resize(1);
        EXPECT_TRUE(mentions(error_of([&] { compare(device, scenes, settings(), stopper.observer()); }),
                             "nothing to compare"));
    });
}

TEST(SceneNames, AreFitForFilesAndUnique) {
    std::vector<Scene> scenes(4);
    scenes[0].name = "living room/é";
    scenes[1].name = "desk";
    scenes[2].name = "desk";
    EXPECT_EQ(unique_names(scenes), (std::vector<std::string>{"living-room---", "desk", "desk-2", "scene"}));
}

}  // namespace
}  // namespace nearlight::core
