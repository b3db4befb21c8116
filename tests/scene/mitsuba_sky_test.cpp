// SPDX-License-Identifier: Apache-2.0
// Expected radiances and directions come from Mitsuba 3.9.1's sunsky in its RGB variant.
#include <cmath>
#include <numbers>

#include "host/scene/sky/sky_model.h"
#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

void expect_ratio(Vec3 found, Vec3 expected, float tolerance) {
    EXPECT_NEAR(found.x / expected.x, 1.0f, tolerance);
    EXPECT_NEAR(found.y / expected.y, 1.0f, tolerance);
    EXPECT_NEAR(found.z / expected.z, 1.0f, tolerance);
}

Vec3 sky_towards(const SkyModel& model, Vec3 direction, Vec3 sun) {
    return model.radiance(normalize(direction).z, std::acos(dot(normalize(direction), normalize(sun))));
}

double elevation_of(Vec3 sun) {
    return std::asin(normalize(sun).z);
}

TEST(MitsubaSky, RadianceIsThatOfMitsuba) {
    const Vec3 high{1, 0.2f, 0.8f};
    const SkyModel clear(3.0, {0.3f, 0.3f, 0.3f}, elevation_of(high));
    expect_ratio(sky_towards(clear, {0, 0, 1}, high), {0.02025571f, 0.03675911f, 0.07440025f}, 1e-4f);
    expect_ratio(sky_towards(clear, {1, 0, 0.5f}, high), {0.17618175f, 0.21220726f, 0.25358558f}, 1e-4f);
    expect_ratio(sky_towards(clear, {-1, -1, 0.05f}, high), {0.15475084f, 0.20773841f, 0.23180231f}, 1e-4f);
    const Vec3 low{1, 0.2f, 0.1f};
    const SkyModel hazy(6.5, {0.7f, 0.7f, 0.7f}, elevation_of(low));
    expect_ratio(sky_towards(hazy, {0, 0, 1}, low), {0.00962427f, 0.01533926f, 0.02187977f}, 1e-4f);
    expect_ratio(sky_towards(hazy, {1, 0, 0.5f}, low), {0.1456849f, 0.11171092f, 0.0691696f}, 1e-4f);
}

TEST(MitsubaSky, ASingularTransformIsAnErrorWithItsLine) {
    const SceneFiles files;
    const std::string error = file_error([&] {
        files.load_xml("<emitter type='sunsky'><vector name='sun_direction' x='0' y='1' z='1'/>" +
                       to_world("<scale x='0' y='1' z='1'/>") + "</emitter>");
    });
    EXPECT_TRUE(mentions(error, "scene.xml:2: ")) << error;
    EXPECT_TRUE(mentions(error, "singular")) << error;
}

TEST(MitsubaSky, PlaceAndTimeTellTheSun) {
    expect_near(sun_direction({}), {0.0513851f, 0.691748f, 0.720308f}, 2e-3f);
    expect_near(sun_direction({.latitude = -33.9,
                               .longitude = 151.2,
                               .timezone = 10,
                               .year = 2021,
                               .month = 12,
                               .day = 3,
                               .hour = 8.5}),
                {-0.0287181f, -0.696303f, 0.717173f}, 2e-3f);
}

TEST(MitsubaSky, LoadedSunAndMap) {
    const SceneFiles files;
    const auto load = [&](const std::string& body, const char* type = "sunsky") {
        return files.load_xml("<emitter type='" + std::string(type) + "'>" + body + "</emitter>").environment;
    };
    const std::string high = "<vector name='sun_direction' value='1, 0.2, 0.8'/>";
    const EnvironmentLight light = load(high);
    // Mitsuba divides by a solid angle that single precision knows to 0.3 % only; in its samples that
    // cancels.
    expect_ratio(light.sun_radiance, {20980.871f, 16973.475f, 12067.017f}, 3e-3f);
    expect_near(light.sun_direction, normalize(Vec3{1, 0.2f, 0.8f}));
    // A sun of 4° has the power of the usual one.
    const EnvironmentLight wide = load(
        "<vector name='sun_direction' value='1, 0.2, 0.1'/><float name='turbidity' value='6.5'/><float "
        "name='sun_aperture' value='4'/>");
    expect_ratio(wide.sun_radiance, {74.40637f, 33.262386f, 6.6337976f}, 5e-4f);

    // The pixel towards (0.5, 0.1, 1) in the frame in which +Z is up.
    const Vec3 direction = normalize(Vec3{0.5f, 0.1f, 1});
    const auto row =
        static_cast<std::size_t>(std::acos(direction.z) / kPi * static_cast<float>(light.height));
    const auto column = static_cast<std::size_t>(std::atan2(direction.x, direction.y) / (2 * kPi) *
                                                 static_cast<float>(light.width));
    expect_ratio(light.radiance[row * static_cast<std::size_t>(light.width) + column],
                 {0.0473597f, 0.06835134f, 0.10995255f}, 0.01f);
    expect_near(transform_vector(light.to_world, {0, 1, 0}), {0, 0, 1});
    EXPECT_TRUE(is_zero(light.radiance.back()));

    EXPECT_EQ(load(high + "<float name='sun_scale' value='0'/>").sun_half_angle, 0.0f);
    const EnvironmentLight old_sun = load("<vector name='sunDirection' value='1, 2, 0'/>", "sun");
    expect_near(old_sun.sun_direction, normalize(Vec3{1, 2, 0}));
    EXPECT_EQ(old_sun.width, 1);
    expect_near(transform_vector(load("", "sky").to_world, {0, 1, 0}), {0, 1, 0});
}

/// In files of Mitsuba 0.5 and 0.6, +Y is up for every kind of sky, and a scale of the sun or the sky
/// replaces the common one.
TEST(MitsubaSky, OldFilesHaveTheirOwnConventions) {
    const SceneFiles files;
    const auto load = [&](const std::string& version, const std::string& type, const std::string& body) {
        return load_scene(files.write("old.xml", "<scene version='" + version + "'><emitter type='" + type +
                                                     "'>" + body + "</emitter></scene>"));
    };
    const std::string high = "<vector name='sunDirection' x='1' y='2' z='-0.5'/>";
    const Scene old = load("0.6.0", "sunsky", high + "<float name='scale' value='3'/>");
    expect_near(old.environment.sun_direction, normalize(Vec3{1, 2, -0.5f}));
    expect_near(transform_vector(old.environment.to_world, {0, 1, 0}), {0, 1, 0});
    EXPECT_TRUE(has_note(old, "+Y up"));
    EXPECT_TRUE(has_note(load("3.0.0", "sunsky", high), "below the horizon"));

    const Scene replaced =
        load("0.5.0", "sunsky", high + "<float name='scale' value='9'/><float name='sunScale' value='3'/>");
    expect_ratio(replaced.environment.sun_radiance, old.environment.sun_radiance, 1e-6f);
    const std::string albedo = "<rgb name='albedo' value='0.2'/>";
    EXPECT_EQ(load("0.5.0", "sunsky", high).environment.radiance,
              load("0.5.0", "sunsky", high + albedo).environment.radiance);
}

TEST(MitsubaSky, NightIsBlackAndBadParametersAreRefused) {
    const SceneFiles files;
    const Scene night =
        files.load_xml("<emitter type='sunsky'><vector name='sun_direction' value='0, 1, -0.1'/></emitter>");
    EXPECT_TRUE(has_note(night, "below the horizon"));
    EXPECT_TRUE(is_zero(night.environment.radiance.at(0)));
    for (const auto& [body, expected] :
         {std::pair{"<float name='turbidity' value='11'/>", "from 1 to 10"},
          {"<float name='sky_scale' value='-1'/>", "negative"},
          {"<float name='stretch' value='2'/>", "stretch"},
          {"<rgb name='albedo' value='1,2,1'/>", "albedo"},
          {"<vector name='sun_direction' value='0,0,1'/><float name='hour' value='3'/>", "either"}}) {
        const std::string message = file_error([&, &text = body] {
            files.load_xml("<emitter type='sunsky'>" + std::string(text) + "</emitter>");
        });
        EXPECT_TRUE(mentions(message, expected)) << message;
    }
}

}  // namespace
}  // namespace nearlight::core
