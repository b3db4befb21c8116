// SPDX-License-Identifier: Apache-2.0
// Tests scenes, devices and sessions as other programs use them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>

#include "nearlight/nearlight.h"
#include "tests/support/face_device_fixture.h"

namespace nearlight {
namespace {

using testing::HasSubstr;

/// A floor of 2 m × 2 m at z = 0 that reflects one half, under a point light of 1, 2 and 3 W/sr at z = 1.
const std::filesystem::path kFloor = std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "tests/install/floor.xml";

template <typename Action>
std::optional<Error> error_of(Action&& action) {
    try {
        action();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "nothing was thrown";
    return std::nullopt;
}

TEST(LibraryScene, TellsItsFacts) {
    const Scene scene = Scene::load(kFloor);
    EXPECT_EQ(scene.source(), kFloor);
    EXPECT_EQ(scene.triangle_count(), 2u);
    EXPECT_EQ(scene.width(), 64);
    EXPECT_EQ(scene.height(), 64);
    EXPECT_EQ(scene.bounds().min.x, -1.0f);
    EXPECT_EQ(scene.bounds().max.y, 1.0f);
    EXPECT_EQ(scene.bounds().max.z, 0.0f);
    EXPECT_TRUE(scene.notes().empty());
    EXPECT_EQ(scene.hash(), Scene::load(kFloor).hash());
}

TEST(LibraryScene, MissingFilesAreErrors) {
    const auto error = error_of([] { Scene::load("nosuch.xml"); });
    EXPECT_EQ(error->kind(), ErrorKind::file);
    EXPECT_THAT(error->what(), HasSubstr("nosuch.xml"));
}

/// One session serves all cases, because each session compiles kernels.
class LibrarySession : public test::FaceDeviceTest {
  protected:
    static void SetUpTestSuite() {
        if (!list_devices().empty()) {
            session_.emplace(Devices::choose(), Scene::load(kFloor));
        }
    }
    static void TearDownTestSuite() { session_.reset(); }
    static Session& session() { return *session_; }

  private:
    static std::optional<Session> session_;
};
std::optional<Session> LibrarySession::session_;

/// I·cosθ/d², and just above the floor its radiosity.
TEST_F(LibrarySession, IrradianceFollowsTheInverseSquareLaw) {
    const std::vector<Vec3> points{{0, 0, 0}, {0.75f, 0, 0}, {0, -0.5f, 0.5f}, {0, 0, 0.01f}};
    const std::vector<Vec3> normals{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, -1}};
    const std::vector<double> expected{1.0, 0.8 / 1.5625, std::sqrt(0.5) / 0.5, 0.5};
    const VplSet vpls = session().sample(session().look(), {.vpl_count = 500});
    const std::vector<Vec3> light =
        session().irradiance(points, normals, vpls, {.direct_samples = 16, .paths = 64});
    ASSERT_EQ(light.size(), points.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
        EXPECT_NEAR(light[i].x, expected[i], 0.02 * expected[i]) << i;
        EXPECT_NEAR(light[i].y, 2 * expected[i], 0.04 * expected[i]) << i;
        EXPECT_NEAR(light[i].z, 3 * expected[i], 0.06 * expected[i]) << i;
    }
    EXPECT_TRUE(session().irradiance({}, {}, vpls).empty());
}

/// The floor under a pane of solid glass, which light samples pass only where glass is clear.
TEST_F(LibrarySession, ClearGlassLetsLightSamplesThrough) {
    std::ifstream floor(kFloor);
    std::string text(std::istreambuf_iterator<char>(floor), {});
    text.insert(text.rfind("</scene>"), R"(<shape type="rectangle">
            <transform name="to_world"><translate z="0.5"/></transform><bsdf type="dielectric"/></shape>)");
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "nearlight_pane.xml";
    std::ofstream(file) << text;
    for (const bool is_clear : {false, true}) {
        const Scene scene = Scene::load(file, {.clear_glass = is_clear});
        Session below(Devices::choose(), scene);
        const VplSet none = below.sample(below.look(), {.vpl_count = 0});
        const std::vector<Vec3> point{{0, 0, 0}};
        const std::vector<Vec3> up{{0, 0, 1}};
        const float light = below.irradiance(point, up, none, {.paths = 0}).front().x;
        EXPECT_NEAR(light, is_clear ? 0.96f : 0.0f, 0.05f) << (is_clear ? "clear" : "glass");
    }
    std::filesystem::remove(file);
}

TEST_F(LibrarySession, WithoutLightsThereIsDirectLight) {
    const VplSet none = session().sample(session().look(), {.vpl_count = 0});
    EXPECT_TRUE(none.lights().empty());
    const std::vector<Vec3> point{{0, 0, 0}};
    const std::vector<Vec3> up{{0, 0, 1}};
    EXPECT_NEAR(session().irradiance(point, up, none, {.paths = 0}).front().x, 1.0f, 1e-4f);
}

/// Light takes two edges from a lamp over a surface to the eye.
TEST_F(LibrarySession, NothingIsLitAtADepthOfOne) {
    const View view = session().look({.max_depth = 1});
    const VplSet none = session().sample(view, {.vpl_count = 0});
    const std::vector<Vec3> point{{0, 0, 0}};
    const std::vector<Vec3> up{{0, 0, 1}};
    const Vec3 light = session().irradiance(point, up, none, {.paths = 0}).front();
    EXPECT_EQ(light.x, 0.0f);
}

TEST_F(LibrarySession, DecidesWhatTheSettingsLeaveOpen) {
    const View view = session().look({.height = 48});
    EXPECT_EQ(view.width(), 64);
    EXPECT_EQ(view.height(), 48);
    EXPECT_EQ(view.max_depth(), 256u);
    EXPECT_GT(view.range(), 1.0f);
    EXPECT_FLOAT_EQ(view.clamp_radius(), view.range() / 20);
    EXPECT_EQ(session().look({.range = 0.5f, .clamp_radius = 0.2f}).clamp_radius(), 0.2f);
}

TEST(LibraryScene, HasACamera) {
    const CameraPose pose = Scene::load(kFloor).camera();
    EXPECT_FLOAT_EQ(pose.origin.y, -1.5f);
    EXPECT_FLOAT_EQ(pose.target.y, -1.5f + std::sqrt(0.5f));
    EXPECT_FLOAT_EQ(pose.target.z, 1.5f - std::sqrt(0.5f));
    EXPECT_FLOAT_EQ(pose.up->z, std::sqrt(0.5f));
    EXPECT_DOUBLE_EQ(pose.fov_x_degrees.value(), 60.0);
}

/// From straight above, P of the middle is the middle of the floor, and a field of view of 90 degrees from 1
/// m shows it to its borders.
TEST_F(LibrarySession, LooksFromAnotherPlace) {
    const CameraPose above{
        .origin = {0, 0, 1}, .target = {0, 0, 0}, .up = Vec3{0, 1, 0}, .fov_x_degrees = 90};
    const View view = session().look({.camera = above, .width = 65, .height = 65});
    const VplSet vpls = session().sample(session().look(), {.vpl_count = 10});
    const Image place = layer(session().gather(view, vpls, {.samples_per_pixel = 1}).image, "P");
    EXPECT_NEAR(place.at(32, 32, 0), 0.0f, 0.02f);
    EXPECT_NEAR(place.at(32, 32, 1), 0.0f, 0.02f);
    EXPECT_NEAR(place.at(64, 0, 0), 1.0f, 0.04f);
    EXPECT_NEAR(place.at(64, 0, 1), 1.0f, 0.04f);
}

/// The scene's own pose, given by hand, sees what the scene's camera sees.
TEST_F(LibrarySession, TheScenesOwnPoseChangesNothing) {
    const RenderSettings settings{.sampling = {.vpl_count = 50}, .gather = {.samples_per_pixel = 1}};
    RenderSettings posed = settings;
    posed.view.camera = Scene::load(kFloor).camera();
    const Image place = layer(session().render(settings).image, "P");
    const Image same = layer(session().render(posed).image, "P");
    for (std::size_t i = 0; i < place.values.size(); ++i) {
        ASSERT_NEAR(place.values[i], same.values[i], 1e-4f) << i;
    }
}

TEST_F(LibrarySession, CamerasThatCannotStandAreRefused) {
    const auto reason = [](const CameraPose& pose) {
        const auto error = error_of([&] { session().look({.camera = pose}); });
        EXPECT_EQ(error->kind(), ErrorKind::invalid_argument);
        EXPECT_EQ(error->setting(), "camera");
        return std::string(error->what());
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(reason({.origin = {kNan, 0, 0}, .target = {0, 0, 0}}), HasSubstr("origin"));
    EXPECT_THAT(reason({.origin = {0, 0, 1}, .target = {0, INFINITY, 0}}), HasSubstr("target"));
    EXPECT_THAT(reason({.origin = {0, 0, 1}, .target = {0, 0, 1}}), HasSubstr("target is its origin"));
    EXPECT_THAT(reason({.origin = {0, 0, 1}, .target = {0, 0, 0}, .up = Vec3{0, 0, 1}}), HasSubstr("`up`"));
    EXPECT_THAT(reason({.origin = {0, 0, 1}, .target = {0, 1, 0}, .fov_x_degrees = 180}),
                HasSubstr("field of view"));
}

/// The floor reflects half of what the light sends into its solid angle, 2π/3.
TEST_F(LibrarySession, LightsCarryTheReflectedFlux) {
    const VplSet vpls = session().sample(session().look(), {.vpl_count = 1000}, 3);
    const std::vector<VirtualPointLight> lights = vpls.lights();
    ASSERT_EQ(lights.size(), vpls.size());
    double red = 0;
    for (const VirtualPointLight& light : lights) {
        EXPECT_NEAR(light.position.z, 0.0f, 1e-3f);
        EXPECT_EQ(light.normal.z, 1.0f);
        EXPECT_FLOAT_EQ(light.power.y, 2 * light.power.x);
        red += light.power.x;
    }
    EXPECT_NEAR(red, 0.5 * 2.0943951, 0.02);
}

/// At the picture's centre the camera sees the floor's centre, whose radiance is ρ·E/π.
TEST_F(LibrarySession, StepsAndOneCallMakeTheSamePicture) {
    const View view = session().look();
    const VplSet vpls = session().sample(view, {.vpl_count = 100});
    const Picture steps = session().gather(view, vpls, {.samples_per_pixel = 1});
    const Picture whole =
        session().render({.sampling = {.vpl_count = 100}, .gather = {.samples_per_pixel = 1}});
    EXPECT_EQ(steps.image.values, whole.image.values);
    EXPECT_EQ(steps.vpl_count, whole.vpl_count);
    EXPECT_EQ(steps.image.channels, picture_channels());
    EXPECT_FALSE(steps.interrupted);
    EXPECT_NEAR(layer(steps.image, "direct").at(32, 32, 0), 0.5 / M_PI, 0.01);

    std::vector<float> rows;
    EXPECT_TRUE(session().gather_rows(
        view, vpls, {.samples_per_pixel = 1}, 0,
        [&](std::span<const float> more) { rows.insert(rows.end(), more.begin(), more.end()); }));
    EXPECT_EQ(rows, steps.image.values);
}

TEST_F(LibrarySession, ACallbackStopsAPicture) {
    const Picture picture =
        session().render({.view = {.width = 256, .height = 256}}, [](double) { return false; });
    EXPECT_TRUE(picture.interrupted);
    EXPECT_EQ(picture.image.values.size(), 256u * 256 * picture_channels().size());
}

TEST_F(LibrarySession, SettingsOutOfRangeAreNamed) {
    const auto setting_of = [](auto&& action) {
        const auto error = error_of(action);
        EXPECT_EQ(error->kind(), ErrorKind::invalid_argument);
        return std::string(error->setting());
    };
    EXPECT_EQ(setting_of([] { session().look({.width = 0}); }), "width");
    EXPECT_EQ(setting_of([] { session().look({.range = std::numeric_limits<float>::quiet_NaN()}); }),
              "range");
    const View view = session().look();
    EXPECT_EQ(setting_of([&] { session().sample(view, {.close_fraction = 1.5f}); }), "close_fraction");
    const VplSet vpls = session().sample(view, {.vpl_count = 10});
    EXPECT_EQ(setting_of([&] { session().gather(view, vpls, {.samples_per_pixel = 0}); }),
              "samples_per_pixel");
    const std::vector<Vec3> point{{0, 0, 0}};
    EXPECT_EQ(setting_of([&] { session().irradiance(point, {}, vpls); }), "normals");
    EXPECT_EQ(setting_of([&] { session().irradiance(point, point, vpls); }), "normals");
    const std::vector<Vec3> nowhere{{0, std::numeric_limits<float>::quiet_NaN(), 0}};
    EXPECT_EQ(setting_of([&] { session().irradiance(nowhere, {{{0, 0, 1}}}, vpls); }), "points");
    EXPECT_EQ(setting_of([] { session().render({.passes = 0}); }), "passes");
}

TEST_F(LibrarySession, ProductsOfAnotherSessionAreRefused) {
    Session other(Devices::choose(), Scene::load(kFloor));
    const View view = other.look();
    EXPECT_EQ(error_of([&] { session().sample(view); })->kind(), ErrorKind::invalid_argument);
}

/// They share what they need with it.
TEST_F(LibrarySession, ProductsOutliveTheirSession) {
    std::optional<VplSet> vpls;
    {
        Session other(Devices::choose(), Scene::load(kFloor));
        vpls = other.sample(other.look(), {.vpl_count = 50});
    }
    EXPECT_EQ(vpls->lights().size(), vpls->size());
}

TEST_F(LibrarySession, WarningsGoToTheSink) {
    std::vector<std::string> warnings;
    set_message_sink([&](MessageLevel level, std::string_view text) {
        if (level == MessageLevel::warning) {
            warnings.emplace_back(text);
        }
    });
    const std::filesystem::path dark =
        std::filesystem::temp_directory_path() / "nearlight-library-test-dark.xml";
    std::ofstream(dark) << "<scene version='3.0.0'><shape type='rectangle'/></scene>";
    Scene::load(dark);
    set_message_sink({});
    std::filesystem::remove(dark);
    EXPECT_THAT(warnings, testing::Contains(HasSubstr("nothing in the scene emits light")));
}

TEST(LibraryScene, CameraAndLightCanBeReplaced) {
    const std::uint64_t own = Scene::load(kFloor).hash();
    EXPECT_NE(Scene::load(kFloor, {.environment = "0.5,0.5,1"}).hash(), own);
    EXPECT_NE(Scene::load(kFloor, {.sun = SunPosition{30, 40}}).hash(), own);
    EXPECT_NE(Scene::load(kFloor, {.light_scale = 2}).hash(), own);
    EXPECT_NE(Scene::load(kFloor, {.origin = Vec3{0, 0, 5}, .target = Vec3{0, 0, 0}}).hash(), own);
    EXPECT_THROW(Scene::load(kFloor, {.camera = "nosuch"}), Error);
    EXPECT_THROW(Scene::load(kFloor, {.fov_x_degrees = 180.0}), Error);
}

TEST(LibraryDevices, UnknownOnesAreErrors) {
    const auto error = error_of([] { Devices::choose("nosuch-device"); });
    EXPECT_EQ(error->kind(), ErrorKind::no_device);
}

}  // namespace
}  // namespace nearlight
