// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

/// The least and the greatest distance of vertices from a point.
std::pair<float, float> distances(const Scene& scene, Vec3 center) {
    std::pair<float, float> range{1e30f, 0.0f};
    for (const Vertex& vertex : scene.vertices) {
        const float distance = length(vertex.position - center);
        range = {std::min(range.first, distance), std::max(range.second, distance)};
    }
    return range;
}

/// Mitsuba takes the radius along the x axis; the expected numbers are those of its bounding boxes.
TEST(MitsubaShape, UnevenSpheresStayRound) {
    const SceneFiles files;
    struct Case {
        const char* transform;
        float radius;
    };
    for (const Case& c : {Case{"<scale value='2,1,0.5'/>", 2.0f}, Case{"<scale value='-2,1,1'/>", 2.0f},
                          Case{"<rotate z='1' angle='30'/><scale value='2,1,0.5'/>", 1.80278f},
                          Case{"<scale value='2,1,0.5'/><rotate z='1' angle='30'/>", 2.0f},
                          Case{"<matrix value='1 0.5 0 0 0 1 0 0 0 0 1 0 0 0 0 1'/>", 1.0f}}) {
        const Scene scene = files.load_xml(shape("sphere", to_world(c.transform)));
        EXPECT_TRUE(has_note(scene, "stays a sphere"));
        const auto [min, max] = distances(scene, {0, 0, 0});
        EXPECT_NEAR(min, c.radius, 2e-3f * c.radius) << c.transform;
        EXPECT_NEAR(max, c.radius, 2e-3f * c.radius) << c.transform;
    }
    const std::string center = "<point name='center' x='1' y='0' z='0'/><float name='radius' value='2'/>";
    const Scene moved = files.load_xml(shape("sphere", center + to_world("<scale value='2,1,0.5'/>")));
    EXPECT_NEAR(distances(moved, {2, 0, 0}).second, 4.0f, 0.01f);
    const std::string lamp = "<emitter type='area'><rgb name='radiance' value='1 2 3'/></emitter>";
    const Scene shining = files.load_xml(shape("sphere", lamp + to_world("<scale value='2,1,0.5'/>")));
    ASSERT_EQ(shining.round_lamps.size(), 1u);
    EXPECT_FLOAT_EQ(shining.round_lamps[0].radius, 2.0f);
}

TEST(MitsubaShape, RoundSpheresAreNotNoted) {
    const SceneFiles files;
    const Scene even = files.load_xml(shape("sphere", to_world("<scale value='2'/>")));
    EXPECT_FALSE(has_note(even, "stays a sphere"));
    const Scene point = files.load_xml(shape("sphere", "<float name='radius' value='0'/>"));
    EXPECT_FALSE(has_note(point, "stays a sphere"));
    const Scene placed =
        files.load_xml("<shape type='shapegroup' id='g'>" + shape("sphere") + "</shape>" +
                       shape("instance", "<ref id='g'/>" + to_world("<scale value='2,1,1'/>")));
    EXPECT_FALSE(has_note(placed, "stays a sphere"));
    EXPECT_NEAR(distances(placed, {0, 0, 0}).second, 2.0f, 0.01f) << "it is an ellipsoid, as in Mitsuba";
}

}  // namespace
}  // namespace nearlight::core
