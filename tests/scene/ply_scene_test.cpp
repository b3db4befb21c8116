// SPDX-License-Identifier: Apache-2.0
// PLY files as whole scenes.
#include <gtest/gtest.h>

#include "host/scene/places.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

const std::string kHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

Material only_side(const Scene& scene) {
    return scene.materials.at(scene.materials.at(scene.triangles.at(0).material).child[0]);
}

TEST(PlyScene, IsGreyAndHasCameraAndLight) {
    const SceneFiles files;
    const Scene scene = load_scene(files.write("a.ply", kHeader + kFace + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    EXPECT_EQ(scene.name, "a");
    expect_near(only_side(scene).reflectance.value, {0.5f, 0.5f, 0.5f});
    EXPECT_LT(only_side(scene).reflectance.texture, 0);
    EXPECT_GT(scene.environment.width, 0);
    EXPECT_TRUE(has_note(scene, "a.ply: the file has no camera"));
    expect_near(scene.vertices.at(0).normal, {0, 0, 1});
}

TEST(PlyScene, ColoursOfVerticesAreSrgb) {
    const SceneFiles files;
    const auto first_color = [&](const std::string& type, const std::string& color) {
        std::string header = kHeader;
        for (const char* channel : {"red", "green", "blue"}) {
            header += "property " + type + " " + channel + "\n";
        }
        const Scene scene = load_scene(files.write("c.ply", header + kFace + "0 0 0 " + color + "\n1 0 0 " +
                                                                color + "\n0 1 0 " + color + "\n3 0 1 2\n"));
        EXPECT_GE(only_side(scene).reflectance.texture, 0);
        return scene.vertex_colors.at(0);
    };
    expect_near(first_color("uchar", "255 128 0"), {1, 0.2158605f, 0}, 1e-4f);
    expect_near(first_color("float", "1 0.5 0"), {1, 0.2140411f, 0}, 1e-4f);
    EXPECT_GT(first_color("float", "1.001 0.5 0").y, 0.2f) << "a little over 1 makes no bytes of them";
}

TEST(PlyScene, PolygonsThatAreNotConvexAreNotFilled) {
    const SceneFiles files;
    std::string header = kHeader;
    header.replace(header.find("vertex 3"), 8, "vertex 5");
    const Scene scene = load_scene(
        files.write("n.ply", header + kFace + "0 0 0\n2 0 0\n2 2 0\n1 0.5 0\n0 2 0\n5 0 1 2 3 4\n"));
    float area = 0;
    for (const Triangle& t : scene.triangles) {
        const Vec3 a = scene.vertices[t.v0].position;
        area += 0.5f * length(cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a));
    }
    EXPECT_FLOAT_EQ(area, 2.5f);
}

/// Corners at the same place are one, also where the file has them once for each face.
TEST(PlyScene, FacesThatShareNoVertexAreSmoothToo) {
    EXPECT_EQ(places_of(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}), (std::vector<uint>{0, 1, 0}));
    const SceneFiles files;
    const Scene scene = load_scene(files.write(
        "s.ply",
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 -1 0\n1 0 0\n0 0 0\n0 1 0.3\n3 0 2 1\n3 4 3 5\n"));
    const auto normal = [&](std::size_t triangle, std::size_t corner) {
        const Triangle t = scene.triangles.at(triangle);
        return scene.vertices.at(corner == 0 ? t.v0 : corner == 1 ? t.v1 : t.v2).normal;
    };
    expect_near(normal(0, 0), normal(1, 0));
    EXPECT_LT(normal(0, 0).y, -0.1f);
    expect_near(normal(0, 1), {0, 0, 1});
}

}  // namespace
}  // namespace nearlight::core
