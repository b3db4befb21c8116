// SPDX-License-Identifier: Apache-2.0
// Tests the renderer's thread as the window uses it.
#include "viewer/renderer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <numbers>
#include <semaphore>
#include <thread>
#include <utility>

#include "nearlight/error.h"
#include "tests/support/error_matchers.h"
#include "tests/support/face_device_fixture.h"
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

/// Writes and loads the floor with a wall at x = −1 that reflects one half too.
Scene load_corner() {
    std::ifstream floor(kFloor);
    std::string text(std::istreambuf_iterator<char>(floor), {});
    text.insert(text.rfind("</scene>"), R"(<shape type="rectangle">
        <transform name="to_world"><rotate y="1" angle="90"/><translate x="-1"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.5, 0.5"/></bsdf></shape>)");
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "nearlight_corner.xml";
    std::ofstream(file) << text;
    Scene scene = Scene::load(file);
    std::filesystem::remove(file);
    return scene;
}

RenderSettings few_samples() {
    RenderSettings settings;
    settings.sampling.vpl_count = 200;
    settings.gather.samples_per_pixel = 4;
    return settings;
}

class RendererTest : public test::FaceDeviceTest {
  protected:
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
    EXPECT_FALSE(first->smoothed) << "nothing more will take the pattern out";
    EXPECT_GT(first->seconds_to_full, 0.0);
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

/// A renderer of the corner whose thread rests after each step until it may go on.
class SteppedRenderer {
  public:
    SteppedRenderer() : renderer_(Devices::choose(), load_corner, few_samples(), [this] { rest(); }) {}
    ~SteppedRenderer() {
        is_free_ = true;
        going_on_.release();
    }
    SteppedRenderer(const SteppedRenderer&) = delete;
    SteppedRenderer& operator=(const SteppedRenderer&) = delete;

    Renderer* operator->() { return &renderer_; }
    /// Lets the thread end its next step. The first one loads the scene. Returns the latest frame.
    std::shared_ptr<const Frame> step() {
        if (std::exchange(has_begun_, true)) {
            going_on_.release();
        }
        EXPECT_TRUE(resting_.try_acquire_for(kPatience));
        return renderer_.frame();
    }

  private:
    void rest() {
        if (!is_free_) {
            resting_.release();
            going_on_.acquire();
        }
    }
    bool has_begun_ = false;
    std::atomic<bool> is_free_ = false;
    std::counting_semaphore<> resting_{0};
    std::counting_semaphore<> going_on_{0};
    Renderer renderer_;  ///< declared last, because its thread uses the others
};

/// Pictures of few samples are smoothed for the eye, as long as more are to come.
TEST_F(RendererTest, OnlyUnfinishedPicturesAreSmoothed) {
    SteppedRenderer renderer;
    EXPECT_FALSE(renderer.step()) << "the scene";
    for (int i = 0; i < 5; ++i) {
        SCOPED_TRACE("a small picture, a first one and three passes: " + std::to_string(i));
        const auto frame = renderer.step();
        ASSERT_TRUE(frame && frame->smoothed);
        EXPECT_NE(frame->smoothed->values, frame->image.values);
        EXPECT_EQ(&frame->shown(), &*frame->smoothed);
        EXPECT_FALSE(renderer->is_done());
    }
    const auto last = renderer.step();
    EXPECT_TRUE(renderer->is_done());
    EXPECT_FALSE(last->smoothed);
    EXPECT_EQ(&last->shown(), &last->image);
}

/// Who asks for less than there is already sees the picture that is finished by that.
TEST_F(RendererTest, FewerSamplesFinishThePicture) {
    SteppedRenderer renderer;
    auto before = renderer.step();
    while (!before || before->samples < 2) {
        before = renderer.step();
    }
    EXPECT_TRUE(before->smoothed);
    renderer->set_samples(2);
    EXPECT_TRUE(renderer->is_done());
    EXPECT_FALSE(renderer->frame()->smoothed);
    EXPECT_EQ(renderer->frame()->image.values, before->image.values);
    EXPECT_EQ(renderer->frame()->samples, 2u);
}

/// VPLs are not downloaded again for each of the passes that they serve.
TEST_F(RendererTest, PassesOfOneSetShareItsLights) {
    SteppedRenderer renderer;
    renderer.step();
    EXPECT_FALSE(renderer.step()->lights) << "small pictures show no dots";
    const auto full = renderer.step();
    const auto first = renderer.step();
    const auto second = renderer.step();
    EXPECT_NE(full->lights, first->lights) << "the first pass makes VPLs";
    EXPECT_EQ(first->lights, second->lights);
    EXPECT_EQ(first->lights->size(), first->vpls->size());
}

/// VPLs that could not be made when they were asked for are made with the next picture.
TEST_F(RendererTest, AFailureDoesNotForgetThatVplsAreOld) {
    SteppedRenderer renderer;
    while (!renderer->is_done()) {
        renderer.step();
    }
    RenderSettings more = few_samples();
    more.sampling.vpl_count = 1000;
    RenderSettings bad = more;
    bad.view.camera = CameraPose{.origin = {0, 0, 1}, .target = {0, 0, 1}};
    renderer->show(bad, Change::sampling);
    const std::size_t before = renderer.step()->vpls->size();
    EXPECT_FALSE(renderer->error().empty());
    renderer->show(more, Change::camera);
    const auto small = renderer.step();
    EXPECT_GT(small->divisor, 1);
    EXPECT_GT(small->vpls->size(), 3 * before);
}

/// The irradiance that the wall reflects to (x, 0, 0) for a light of 1 W/sr, by a sum over the wall.
float from_wall(float x) {
    constexpr int kSteps = 400;
    constexpr double kStep = 1.0 / kSteps;
    double sum = 0.0;
    const double across = 1.0 + static_cast<double>(x);
    for (double y = -1.0 + 0.5 * kStep; y < 1.0; y += kStep) {
        for (double z = 0.5 * kStep; z < 1.0; z += kStep) {
            const double lit = std::pow(1.0 + y * y + (1.0 - z) * (1.0 - z), -1.5);
            const double square = across * across + y * y + z * z;
            sum += lit * across * z / (square * square);
        }
    }
    return static_cast<float>(0.5 * sum * kStep * kStep / std::numbers::pi);
}

/// The floor before the wall, which VPLs on the wall light within a clamp radius.
TEST_F(RendererTest, AnInspectionAddsUp) {
    RenderSettings settings = few_samples();
    settings.sampling.vpl_count = 4000;
    settings.view.max_depth = 3;
    settings.view.clamp_radius = 0.7f;
    settings.view.width = settings.view.height = 65;
    constexpr float kX = -0.6f;
    settings.view.camera = CameraPose{.origin = {kX, 0, 3}, .target = {kX, 0, 0}, .up = Vec3{0, 1, 0}};
    Renderer renderer(Devices::choose(), load_corner, settings, [] {});
    ASSERT_TRUE(comes_true([&] { return renderer.is_done(); }));
    renderer.inspect(renderer.frame(), 32, 32);
    ASSERT_TRUE(comes_true([&] { return renderer.inspection() != nullptr; }));
    const auto inspection = renderer.inspection();
    ASSERT_TRUE(inspection->hits_surface);
    EXPECT_NEAR(inspection->position.x, kX, 0.03f);
    const float x = inspection->position.x;
    const float y = inspection->position.y;
    EXPECT_NEAR(inspection->direct.x, std::pow(1.0f + x * x + y * y, -1.5f), 0.01f);
    ASSERT_FALSE(inspection->shares.empty());
    EXPECT_EQ(inspection->shares.back().kind, LightKind::point);
    EXPECT_NEAR(inspection->shares.back().irradiance.x, inspection->direct.x, 0.01f);

    const float expected = from_wall(x);
    EXPECT_NEAR(inspection->from_vpls.x + inspection->remainder.x, expected, 0.05f * expected);
    EXPECT_GT(inspection->from_vpls.x, 0.1f * expected);
    EXPECT_GT(inspection->remainder.x, 0.1f * expected);
    EXPECT_NEAR(inspection->clamped.x, inspection->remainder.x, 0.1f * expected);
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
    EXPECT_EQ(core::test::error_of([&] { renderer.rethrow_error(); }).kind(), ErrorKind::invalid_argument);
    const std::uint64_t state = renderer.frame()->state;
    renderer.show(few_samples(), Change::camera);
    ASSERT_TRUE(comes_true([&] { return renderer.frame()->state > state && renderer.is_done(); }));
    EXPECT_EQ(renderer.error(), "");
    renderer.rethrow_error();
}

}  // namespace
}  // namespace nearlight::viewer
