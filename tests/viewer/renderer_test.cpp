// SPDX-License-Identifier: Apache-2.0
// Tests the renderer's thread as the window uses it.
#include "viewer/renderer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "nearlight/error.h"
#include "viewer/vectors.h"
#include "viewer/vpl_dots.h"

namespace nearlight::viewer {
namespace {

/// A floor of 2 m × 2 m at z = 0 that reflects one half, under a point light of 1, 2 and 3 W/sr at z = 1.
const std::filesystem::path kFloor = std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "tests/install/floor.xml";
constexpr std::chrono::seconds kPatience{200};

Scene load_floor() {
    return Scene::load(kFloor);
}

RenderSettings few_samples() {
    RenderSettings settings;
    settings.sampling.vpl_count = 200;
    settings.gather.samples_per_pixel = 4;
    return settings;
}

class RendererTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!list_devices().empty()) {
            return;
        }
        if (std::getenv("NEARLIGHT_REQUIRE_DEVICE") != nullptr) {
            FAIL() << "no OpenCL device";
        }
        GTEST_SKIP() << "no OpenCL device";
    }

    template <typename Condition>
    static bool comes_true(const Condition& condition) {
        const auto end = std::chrono::steady_clock::now() + kPatience;
        while (!condition()) {
            if (std::chrono::steady_clock::now() > end) {
                return false;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return true;
    }
};

TEST_F(RendererTest, RefinesAndRestsAndBeginsAnew) {
    std::atomic<int> news = 0;
    Renderer renderer(Devices::choose(), load_floor, few_samples(), [&] { ++news; });
    ASSERT_TRUE(comes_true([&] { return renderer.is_done(); }));
    const auto first = renderer.frame();
    EXPECT_EQ(first->image.width, 64);
    EXPECT_EQ(first->samples, 4u);
    EXPECT_FALSE(first->is_quick);
    EXPECT_GE(news, 3);
    // The camera sees the floor's middle, whose radiance is ρ·E/π.
    EXPECT_NEAR(first->image.at(32, 32, 0), 0.5f / 3.14159f, 0.02f);

    RenderSettings moved = few_samples();
    moved.view.camera = CameraPose{.origin = {0, 0, 3}, .target = {0, 0, 0}, .up = Vec3{0, 1, 0}};
    renderer.show(moved, Change::camera);
    ASSERT_TRUE(comes_true([&] { return renderer.frame()->state > first->state && renderer.is_done(); }));
    EXPECT_NE(renderer.frame()->image.values, first->image.values);
    EXPECT_EQ(renderer.error(), "");
}

TEST_F(RendererTest, AnInspectionAddsUp) {
    Renderer renderer(Devices::choose(), load_floor, few_samples(), [] {});
    ASSERT_TRUE(comes_true([&] { return renderer.is_done(); }));
    renderer.inspect(renderer.frame(), 32, 32);
    ASSERT_TRUE(comes_true([&] { return renderer.inspection() != nullptr; }));
    const auto inspection = renderer.inspection();
    ASSERT_TRUE(inspection->hits_surface);
    EXPECT_NEAR(inspection->direct.x, 1.0f, 0.02f);
    // A flat floor does not light itself.
    EXPECT_NEAR(inspection->from_vpls.x, 0.0f, 1e-3f);
    EXPECT_NEAR(inspection->remainder.x, 0.0f, 0.02f);
    ASSERT_FALSE(inspection->shares.empty());
    EXPECT_EQ(inspection->shares.back().kind, LightKind::point);
    EXPECT_NEAR(inspection->shares.back().irradiance.x, inspection->direct.x, 0.02f);
}

TEST_F(RendererTest, DotsLieInThePicture) {
    Renderer renderer(Devices::choose(), load_floor, few_samples(), [] {});
    ASSERT_TRUE(comes_true([&] { return renderer.is_done(); }));
    const std::vector<VplDot> dots = vpl_dots(*renderer.frame());
    EXPECT_GT(dots.size(), 50u);
    for (const VplDot& dot : dots) {
        EXPECT_GE(dot.x, 0.0f);
        EXPECT_LT(dot.y, 1.0f);
        EXPECT_FALSE(dot.is_hidden);
    }
}

/// A window that is closed in the middle of a pass, or before anything is loaded.
TEST_F(RendererTest, EndsInTheMiddleOfAnything) {
    RenderSettings long_ones = few_samples();
    long_ones.view.width = long_ones.view.height = 2048;
    long_ones.gather.samples_per_pixel = 4096;
    {
        Renderer renderer(Devices::choose(), load_floor, long_ones, [] {});
    }
    Renderer renderer(Devices::choose(), load_floor, long_ones, [] {});
    ASSERT_TRUE(comes_true([&] { return renderer.frame() != nullptr; }));
}

TEST_F(RendererTest, FailuresOfLoadingAreRethrown) {
    Renderer renderer(
        Devices::choose(), [] { return Scene::load("nosuch.xml"); }, few_samples(), [] {});
    const auto fails = [&] {
        try {
            renderer.rethrow_failure();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::file);
            return true;
        }
        return false;
    };
    EXPECT_TRUE(comes_true(fails));
}

/// An impossible setting stops nothing: the error is told, and the next setting is shown.
TEST_F(RendererTest, BadSettingsAreToldAndForgotten) {
    Renderer renderer(Devices::choose(), load_floor, few_samples(), [] {});
    ASSERT_TRUE(comes_true([&] { return renderer.is_done(); }));
    RenderSettings bad = few_samples();
    bad.view.camera = CameraPose{.origin = {0, 0, 1}, .target = {0, 0, 1}};
    renderer.show(bad, Change::camera);
    ASSERT_TRUE(comes_true([&] { return !renderer.error().empty(); }));
    const std::uint64_t state = renderer.frame()->state;
    renderer.show(few_samples(), Change::camera);
    ASSERT_TRUE(comes_true([&] { return renderer.frame()->state > state && renderer.is_done(); }));
    EXPECT_EQ(renderer.error(), "");
}

}  // namespace
}  // namespace nearlight::viewer
