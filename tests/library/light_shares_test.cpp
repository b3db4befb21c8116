// SPDX-License-Identifier: Apache-2.0
// What Session::light_shares() says of each light, compared with the irradiance of all of them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "nearlight/nearlight.h"
#include "tests/support/face_device_fixture.h"

namespace nearlight {
namespace {

/// A floor at z = 0 with a wall at x = −1 that faces it, and a beam above the point (0.5, 0, 0).
std::string room_with(const std::string& emitter) {
    return R"(<scene version="3.0.0">
    <sensor type="perspective"><transform name="to_world">
        <lookat origin="3, -3, 3" target="0, 0, 0" up="0, 0, 1"/></transform></sensor>
    <bsdf type="diffuse" id="white"><rgb name="reflectance" value="0.6, 0.6, 0.6"/></bsdf>
    <shape type="rectangle"><transform name="to_world"><scale value="4"/></transform><ref id="white"/></shape>
    <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="90"/><translate x="-1"/></transform>
        <ref id="white"/></shape>
    <shape type="cube"><transform name="to_world"><scale x="0.1" y="0.1" z="0.1"/>
        <translate x="0.5" z="0.5"/></transform><ref id="white"/></shape>
    )" + emitter +
           "</scene>";
}

float sum_of(Vec3 v) {
    return v.x + v.y + v.z;
}

class SingleLightShares : public test::FaceDeviceTest {
  protected:
    static Scene load(const std::string& emitter) {
        const auto file = std::filesystem::path(testing::TempDir()) /
                          ("nearlight_light_shares_" + std::to_string(getpid()) + ".xml");
        std::ofstream(file) << room_with(emitter);
        Scene scene = Scene::load(file);
        std::filesystem::remove(file);
        return scene;
    }
};

struct EmitterCase {
    const char* name;
    LightKind kind;
    const char* xml;
};
class LightShares : public SingleLightShares, public testing::WithParamInterface<EmitterCase> {};

const std::vector<Vec3> kPoints{{0, 0, 0}, {0.5f, 0, 0}, {-0.7f, 0.5f, 0}};
constexpr Vec3 kUp{0, 0, 1};

TEST_P(LightShares, AddUpToTheIrradiance) {
    Session session(Devices::choose(), load(GetParam().xml));
    const View view = session.look({.ray_budget_pilot = false});
    const VplSet none = session.sample(view, {.vpl_count = 0});
    const VplSet vpls = session.sample(view, {.vpl_count = 500}, 1);
    const std::vector<Vec3> normals(kPoints.size(), kUp);
    const IrradianceSettings many{.direct_samples = 4096, .paths = 0};
    const std::vector<Vec3> direct = session.irradiance(kPoints, normals, none, many);
    const std::vector<Vec3> with_vpls = session.irradiance(kPoints, normals, vpls, many);
    float brightest = 0.0f;
    for (std::size_t i = 0; i < kPoints.size(); ++i) {
        float emitters = 0.0f;
        float vpl_light = 0.0f;
        std::size_t vpl_count = 0;
        for (const LightShare& share : session.light_shares(kPoints[i], kUp, vpls)) {
            (share.kind == LightKind::vpl ? vpl_light : emitters) += sum_of(share.irradiance);
            vpl_count += share.kind == LightKind::vpl ? 1 : 0;
            EXPECT_GE(share.taken_by_clamp.x, 0.0f);
            if (share.kind != LightKind::vpl) {
                EXPECT_EQ(share.kind, GetParam().kind);
            }
        }
        const float expected = sum_of(direct[i]);
        EXPECT_EQ(vpl_count, vpls.size());
        EXPECT_NEAR(emitters, expected, 0.06f * expected + 1e-3f) << "at point " << i;
        EXPECT_NEAR(vpl_light, sum_of(with_vpls[i]) - expected, 0.02f * sum_of(with_vpls[i]))
            << "at point " << i;
        brightest = std::max(brightest, emitters);
    }
    EXPECT_GT(brightest, 0.1f);
}

INSTANTIATE_TEST_SUITE_P(
    Emitters, LightShares,
    testing::Values(
        EmitterCase{"point", LightKind::point,
                    R"(<emitter type="point"><point name="position" x="0.5" y="0" z="2"/>
                       <rgb name="intensity" value="3, 3, 3"/></emitter>)"},
        EmitterCase{"spot", LightKind::spot,
                    R"(<emitter type="spot"><transform name="to_world">
                       <lookat origin="0, 0, 2" target="0.2, 0, 0" up="0, 1, 0"/></transform>
                       <rgb name="intensity" value="5, 5, 5"/><float name="cutoff_angle" value="30"/></emitter>)"},
        EmitterCase{"projector", LightKind::projector,
                    R"(<emitter type="projector"><transform name="to_world">
                       <lookat origin="0, 0, 2" target="0.2, 0, 0" up="0, 1, 0"/></transform>
                       <rgb name="irradiance" value="2, 2, 2"/><float name="fov" value="60"/></emitter>)"},
        EmitterCase{"directional", LightKind::directional,
                    R"(<emitter type="directional"><vector name="direction" x="-0.3" y="0" z="-1"/>
                       <rgb name="irradiance" value="2, 2, 2"/></emitter>)"},
        EmitterCase{"rectangle", LightKind::area,
                    R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/>
                       <translate z="2"/></transform><emitter type="area"><rgb name="radiance" value="2, 2, 2"/>
                       </emitter></shape>)"},
        EmitterCase{"sphere", LightKind::area,
                    R"(<shape type="sphere"><point name="center" x="0.3" y="0" z="1.5"/>
                       <float name="radius" value="0.2"/><emitter type="area">
                       <rgb name="radiance" value="8, 8, 8"/></emitter></shape>)"},
        EmitterCase{"constant", LightKind::environment,
                    R"(<emitter type="constant"><rgb name="radiance" value="0.5, 0.5, 0.5"/></emitter>)"}),
    [](const auto& tested) { return std::string(tested.param.name); });

/// A map whose four quarters of the horizon are red, green, blue and white, and whose first row is brighter.
Image quarters() {
    Image map{.width = 8, .height = 4, .channels = {"R", "G", "B"}};
    const std::vector<Vec3> colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (int row = 0; row < map.height; ++row) {
        for (int column = 0; column < map.width; ++column) {
            const float light = row == 0 ? 1.0f : 0.3f;
            const Vec3 color = colors[static_cast<std::size_t>(column) / 2];
            map.values.insert(map.values.end(), {light * color.x, light * color.y, light * color.z});
        }
    }
    return map;
}

/// Compares what comes from far away with what light samples bring, for each colour and on each side.
void expect_shares_of_all_sides(const Scene& scene, const std::vector<LightKind>& kinds) {
    Session session(Devices::choose(), scene);
    const VplSet none = session.sample(session.look({.ray_budget_pilot = false}), {.vpl_count = 0});
    const std::vector<Vec3> normals{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    const std::vector<Vec3> points(normals.size(), Vec3{0, 1, 1.5f});
    const std::vector<Vec3> expected =
        session.irradiance(points, normals, none, {.direct_samples = 4096, .paths = 0});
    for (std::size_t i = 0; i < points.size(); ++i) {
        SCOPED_TRACE("side " + std::to_string(i));
        Vec3 sum{};
        std::vector<LightKind> found;
        for (const LightShare& share : session.light_shares(points[i], normals[i], none)) {
            found.push_back(share.kind);
            sum = {sum.x + share.irradiance.x, sum.y + share.irradiance.y, sum.z + share.irradiance.z};
        }
        EXPECT_EQ(found, kinds);
        const float tolerance = 0.04f * sum_of(expected[i]) + 1e-3f;
        EXPECT_GT(sum_of(expected[i]), 10 * tolerance);
        EXPECT_NEAR(sum.x, expected[i].x, tolerance);
        EXPECT_NEAR(sum.y, expected[i].y, tolerance);
        EXPECT_NEAR(sum.z, expected[i].z, tolerance);
    }
}

/// The map is so small that interpolation between its rows counts, and turned so that it lies askew.
TEST_F(SingleLightShares, MapsAreTurnedAndInterpolatedAsForPictures) {
    const auto map = std::filesystem::path(testing::TempDir()) /
                     ("nearlight_quarters_" + std::to_string(getpid()) + ".exr");
    write_image(map, quarters());
    const Scene scene = load(R"(<emitter type="envmap"><string name="filename" value=")" + map.string() +
                             R"("/><transform name="to_world"><rotate x="1" angle="90"/>
                             <rotate z="1" angle="25"/></transform></emitter>)");
    std::filesystem::remove(map);
    expect_shares_of_all_sides(scene, {LightKind::environment});
}

TEST_F(SingleLightShares, TheSunAndItsSkyAreTwoLights) {
    expect_shares_of_all_sides(
        load(R"(<emitter type="sunsky"><vector name="sun_direction" x="0.5" y="0.3" z="0.6"/>
                                       <float name="sun_aperture" value="8"/></emitter>)"),
        {LightKind::sun, LightKind::environment});
}

/// A rectangle is two triangles, and one light.
TEST_F(SingleLightShares, TrianglesThatShareVerticesAreOneLight) {
    const std::string lamp = R"(<shape type="rectangle"><transform name="to_world"><scale value="0.2"/>
        <rotate x="1" angle="180"/><translate x="XX" z="2"/></transform><emitter type="area">
        <rgb name="radiance" value="2, 2, 2"/></emitter></shape>)";
    std::string two = lamp + lamp;
    two.replace(two.find("XX"), 2, "-0.5");
    two.replace(two.find("XX"), 2, "0.9");
    Session session(Devices::choose(), load(two));
    const VplSet none = session.sample(session.look(), {.vpl_count = 0});
    const std::vector<LightShare> shares = session.light_shares({0, 0, 0}, kUp, none);
    ASSERT_EQ(shares.size(), 2u);
    EXPECT_NEAR(std::min(shares[0].position.x, shares[1].position.x), -0.5f, 1e-4f);
    EXPECT_NEAR(std::max(shares[0].position.x, shares[1].position.x), 0.9f, 1e-4f);
    EXPECT_NEAR(shares[0].position.z, 2.0f, 1e-4f);
}

TEST_F(SingleLightShares, PointsMustBeSound) {
    Session session(Devices::choose(), load(""));
    const VplSet none = session.sample(session.look(), {.vpl_count = 0});
    EXPECT_THROW(session.light_shares({NAN, 0, 0}, kUp, none), Error);
    EXPECT_THROW(session.light_shares({0, 0, 0}, {0, 0, 2}, none), Error);
}

}  // namespace
}  // namespace nearlight
