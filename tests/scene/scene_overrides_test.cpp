// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_overrides.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "host/image/image_io.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using testing::HasSubstr;
using namespace test;

const std::string kScene =
    "<shape type='rectangle'/><emitter type='constant'><rgb name='radiance' value='1,2,3'/></emitter>"
    "<sensor type='perspective' id='first'><float name='fov' value='60'/></sensor>"
    "<sensor type='perspective' id='second'><float name='fov' value='30'/></sensor>";

class Overrides : public testing::Test {
  protected:
    [[nodiscard]] Scene load(const SceneOverrides& overrides, const std::string& content = kScene) const {
        LoadOptions options;
        options.overrides = overrides;
        return files_.load_xml(content, options);
    }
    void expect_refused(const SceneOverrides& overrides, const std::string& part,
                        const std::string& content = kScene) const {
        try {
            static_cast<void>(load(overrides, content));
            ADD_FAILURE() << part;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
            EXPECT_THAT(error.what(), HasSubstr(part));
        }
    }
    SceneFiles files_;
};

TEST_F(Overrides, NothingChangesWithoutThem) {
    const Scene scene = load({});
    EXPECT_EQ(scene_hash(scene), scene_hash(files_.load_xml(kScene)));
    EXPECT_FALSE(scene.has_open_exposure);
    EXPECT_FALSE(scene.open_veils);
}

TEST_F(Overrides, AnEnvironmentThatIsNotThereCannotBeScaled) {
    const std::string lamp =
        "<shape type='rectangle'><emitter type='area'><rgb name='radiance' value='1'/></emitter></shape>";
    const auto tells = [&](const SceneOverrides& overrides, const std::string& content) {
        const Scene scene = load(overrides, content);
        return std::ranges::any_of(scene.notes, [](const Note& note) {
            return note.text == "the scene has no environment that could be scaled or turned";
        });
    };
    EXPECT_TRUE(tells({.environment_scale = 2}, lamp));
    EXPECT_TRUE(tells({.environment_rotation = 20}, lamp));
    EXPECT_FALSE(tells({}, lamp));
    EXPECT_FALSE(tells({.environment_scale = 2}, kScene));
}

TEST_F(Overrides, CamerasStandAndLookAsTheySay) {
    const SceneCamera camera =
        load({.origin = std::array{0.0, 0.0, 5.0}, .target = std::array{0.0, 0.0, -1.0}, .fov_degrees = 70})
            .camera;
    EXPECT_EQ(camera.fov_x_degrees, 70);
    const Vec3 forward = transform_vector(camera.to_world, {0, 0, 1});
    EXPECT_NEAR(forward.z, -1, 1e-6f);
    EXPECT_NEAR(transform_vector(camera.to_world, {0, 1, 0}).y, 1, 1e-6f);
    // The camera looks at the middle, (0, 0, 0).
    const SceneCamera from_above = load({.origin = std::array{0.0, 9.0, 0.0}}).camera;
    EXPECT_NEAR(transform_vector(from_above.to_world, {0, 0, 1}).y, -1, 1e-6f);
    expect_refused({.origin = std::array{1.0, 2.0, 3.0}, .target = std::array{1.0, 2.0, 3.0}},
                   "its target is its origin");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_refused({.origin = std::array{nan, 2.0, 3.0}}, "finite");
    expect_refused({.fov_degrees = 180}, "field of view");
    EXPECT_EQ(load({.fov_degrees = 179.95}).camera.fov_x_degrees, 179.95);
}

/// The middle of the second scene, whose corners are rounded, is not quite (0.1, 0, 0).
TEST_F(Overrides, ACameraInTheMiddleOfTheSceneNeedsATarget) {
    const std::string aside =
        "<shape type='rectangle'><transform name='to_world'><translate x='0.1'/></transform></shape>"
        "<sensor type='perspective'/>";
    const std::string what =
        "looks at the middle of the scene, and this origin is that middle; give a target";
    expect_refused({.origin = std::array{0.0, 0.0, 0.0}}, what);
    expect_refused({.origin = std::array{0.1, 0.0, 0.0}}, what, aside);
    const SceneOverrides beside{.origin = std::array{0.1, 0.0, 0.001}};
    EXPECT_NEAR(transform_vector(load(beside, aside).camera.to_world, {0, 0, 1}).z, -1, 1e-4f);
    const SceneOverrides with_target{.origin = std::array{0.0, 0.0, 0.0},
                                     .target = std::array{0.0, 0.0, 1.0}};
    EXPECT_NEAR(transform_vector(load(with_target).camera.to_world, {0, 0, 1}).z, 1, 1e-6f);
}

TEST_F(Overrides, TurnNoCameraFarAwayThatOnlyGetsAnotherLens) {
    const auto frame = [&](const SceneOverrides& overrides) {
        return load(overrides,
                    "<shape type='rectangle'/><sensor type='perspective'><transform name='to_world'>"
                    "<lookat origin='100000,3,-100000' target='100000.3,3.2,-100000.7' up='0,1,0'/>"
                    "</transform></sensor>")
            .camera.to_world;
    };
    const Mat4 own = frame({});
    const Mat4 wide = frame({.fov_degrees = 80});
    const Mat4 turned = frame({.up = std::array{0.0, 1.0, 0.0}});
    const Mat4 moved = frame(
        {.origin = std::array{100000.0, 3.0, -100000.0}, .target = std::array{100000.3, 3.2, -100000.7}});
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            EXPECT_EQ(wide(row, column), own(row, column));
            EXPECT_NEAR(turned(row, column), own(row, column), 1e-9);
            EXPECT_NEAR(moved(row, column), own(row, column), 1e-9);
        }
    }
}

/// The scale of an orthographic camera is half the width of what it sees, of which a lens knows nothing.
TEST_F(Overrides, OrthographicCamerasStaySoWithoutAFieldOfView) {
    const auto camera = [&](const SceneOverrides& overrides) {
        return load(overrides,
                    "<shape type='rectangle'/><sensor type='orthographic'><transform name='to_world'>"
                    "<scale value='7'/><lookat origin='0,0,4' target='0,0,0' "
                    "up='0,1,0'/></transform></sensor>")
            .camera;
    };
    const SceneCamera moved = camera({.origin = std::array{0.0, 0.0, -3.0}});
    EXPECT_EQ(moved.kind, CameraKind::orthographic);
    EXPECT_NEAR(length(transform_vector(moved.to_world, {1, 0, 0})), 7, 1e-5f);
    EXPECT_NEAR(transform_vector(moved.to_world, {0, 0, 1}).z, 7, 1e-5f);
    const SceneCamera wide = camera({.fov_degrees = 80});
    EXPECT_EQ(wide.kind, CameraKind::perspective);
    EXPECT_EQ(wide.fov_x_degrees, 80);
    EXPECT_NEAR(length(transform_vector(wide.to_world, {1, 0, 0})), 1, 1e-6f);
    EXPECT_NEAR(transform_point(wide.to_world, {0, 0, 0}).z, 4, 1e-6f);
    EXPECT_NEAR(transform_vector(wide.to_world, {0, 0, 1}).z, -1, 1e-6f);
}

TEST_F(Overrides, SensorsByNameAndNumber) {
    const auto fov_of = [&](const std::string& camera) {
        LoadOptions options;
        options.camera = camera;
        return files_.load_xml(kScene, options).camera.fov_x_degrees;
    };
    EXPECT_NEAR(fov_of("second"), 30, 1e-9);
    EXPECT_NEAR(fov_of("2"), 30, 1e-9);
    EXPECT_NEAR(fov_of(""), 60, 1e-9);
    try {
        fov_of("secand");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("did you mean 'second'?"));
    }
}

TEST_F(Overrides, EnvironmentsAreColoursFilesOrTheSky) {
    const auto first_pixel = [&](const std::string& name) {
        return load({.environment = name}).environment.radiance[0];
    };
    EXPECT_EQ(first_pixel("1,0.5,0.25"), (Vec3{1, 0.5f, 0.25f}));
    EXPECT_EQ(first_pixel("2"), (Vec3{2, 2, 2}));
    EXPECT_NEAR(first_pixel("#ff8000").y, 0.2159f, 1e-3f);
    write_image(files_.path("sky.exr"), {2, 2, {"R", "G", "B"}, {1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0}});
    const EnvironmentLight map =
        load({.environment = files_.path("sky.exr"), .environment_scale = 2}).environment;
    EXPECT_EQ(map.radiance[0], (Vec3{2, 4, 6}));
    EXPECT_TRUE(map.is_interpolated);
    const EnvironmentLight sky = load({.environment = "sky"}).environment;
    EXPECT_GT(sky.width, 100);
    EXPECT_GT(sky.radiance[10].z, sky.radiance[10].x);
    EXPECT_EQ(sky.sun_half_angle, 0.0f);
    expect_refused({.environment = "1,-1,1"}, "not below 0");
    const std::filesystem::path text = files_.write("sky.txt", "not a picture");
    EXPECT_THAT(file_error([&] { static_cast<void>(load({.environment = text})); }), HasSubstr("sky.txt"));
    EXPECT_THAT(file_error([&] { static_cast<void>(load({.environment = "skye"})); }),
                HasSubstr("the environment 'skye' is neither 'sky', nor a colour"));
    EXPECT_THAT(file_error([&] { static_cast<void>(load({.environment = files_.path("none.exr")})); }),
                HasSubstr("none.exr' is neither 'sky', nor a colour such as 0.5 or #88aaff, nor an image"));
}

TEST_F(Overrides, EnvironmentsTurnAboutTheVertical) {
    const Mat4 to_world = load({.environment_rotation = 90}).environment.to_world;
    EXPECT_NEAR(transform_vector(to_world, {0, 0, 1}).x, 1, 1e-6f);
}

TEST_F(Overrides, TheSunStandsWhereItIsPut) {
    const EnvironmentLight own = load({.sun = SunPosition{90, 30}}).environment;
    EXPECT_EQ(own.radiance[0], (Vec3{1, 2, 3}));
    EXPECT_NEAR(own.sun_direction.x, std::sqrt(0.75f), 1e-5f);
    EXPECT_NEAR(own.sun_direction.y, 0.5f, 1e-5f);
    EXPECT_GT(own.sun_radiance.x, 100.0f);
    const EnvironmentLight sky = load({.environment = "sky", .sun = SunPosition{90, 30}}).environment;
    EXPECT_NEAR(sky.sun_direction.x, own.sun_direction.x, 1e-5f);
    // The sky is brightest around its sun.
    const auto brightest = std::max_element(sky.radiance.begin(), sky.radiance.end(),
                                            [](Vec3 a, Vec3 b) { return luminance(a) < luminance(b); });
    const auto index = static_cast<int>(brightest - sky.radiance.begin());
    const float phi =
        2 * kPi * (static_cast<float>(index % sky.width) + 0.5f) / static_cast<float>(sky.width);
    const Vec3 direction = transform_vector(sky.to_world, {std::sin(phi), 0, -std::cos(phi)});
    EXPECT_GT(direction.x, 0.95f);
    expect_refused({.sun = SunPosition{0, -5}}, "elevation");
}

TEST_F(Overrides, TheSkyTurnsAndDimsWithItsSunAndOtherEnvironmentsWithoutIt) {
    const auto turned = [&](const std::string& environment) {
        return load({.environment = environment,
                     .environment_rotation = 90,
                     .environment_scale = 0.5,
                     .sun = SunPosition{90, 0}})
            .environment;
    };
    const EnvironmentLight straight = load({.environment = "sky", .sun = SunPosition{90, 0}}).environment;
    const EnvironmentLight sky = turned("sky");
    EXPECT_NEAR(sky.sun_direction.z, -1, 1e-5f);  // from +X on about +Y
    EXPECT_EQ(sky.sun_radiance, straight.sun_radiance * 0.5f);
    EXPECT_EQ(sky.radiance[10], straight.radiance[10] * 0.5f);
    const EnvironmentLight other = turned("1,1,1");
    EXPECT_NEAR(other.sun_direction.x, 1, 1e-5f);
    EXPECT_EQ(other.sun_radiance, straight.sun_radiance);
    EXPECT_EQ(other.radiance[0], (Vec3{0.5f, 0.5f, 0.5f}));
}

TEST_F(Overrides, AllLightIsScaled) {
    EXPECT_EQ(load({.light_scale = 0.5}).environment.radiance[0], (Vec3{0.5f, 1, 1.5f}));
    expect_refused({.light_scale = -1}, "scale of light");
}

TEST_F(Overrides, LightOfTheirOwnReplacesTheNeutralSky) {
    const std::filesystem::path obj = files_.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_GT(load_scene(obj).environment.width, 1);
    LoadOptions options;
    options.overrides.environment = "0.5";
    const Scene scene = load_scene(obj, options);
    EXPECT_EQ(scene.environment.width, 1);
    EXPECT_TRUE(scene.has_open_exposure);
    EXPECT_TRUE(scene.open_veils);
    options.camera = "1";
    EXPECT_THROW(load_scene(obj, options), Error);
}

}  // namespace
}  // namespace nearlight::core
