// SPDX-License-Identifier: Apache-2.0
// Surfaces of OBJ files that shine.
#include <gtest/gtest.h>

#include "tests/scene/obj_text.h"

namespace nearlight::core {
namespace {

using namespace test;

/// The triangles that shine, by the direction to which they do.
std::vector<Vec3> shining_directions(const Scene& scene) {
    std::vector<Vec3> directions;
    for (const Triangle& t : scene.triangles) {
        if (!is_zero(scene.materials[t.material].emission.value)) {
            const Vec3 a = scene.vertices[t.v0].position;
            directions.push_back(
                normalize(cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a)));
        }
    }
    return directions;
}

TEST(ObjLamps, OpenSurfacesShineToBothSides) {
    const SceneFiles files;
    files.write("m.mtl",
                "newmtl floor\nKd 0.5 0.5 0.5\nnewmtl lamp\nKe 5 5 5\nnewmtl veil\nKe 5 5 5\nd 0.5\n");
    const std::string text =
        "mtllib m.mtl\nv 0 0 0\nv 9 0 0\nv 0 9 0\no ground\nusemtl floor\nf 1 2 3\no light\n";
    for (const char* face : {"f 1 2 3\n", "f 1 3 2\n"}) {
        for (const char* material : {"usemtl lamp\n", "usemtl veil\n"}) {
            const Scene scene = load_obj(files, text + material + face);
            const std::vector<Vec3> directions = shining_directions(scene);
            ASSERT_EQ(directions.size(), 2u);
            expect_near(directions[0], -directions[1], 1e-3f);  // corners move by different hairs
            EXPECT_EQ(scene.object_names.at(scene.objects.back().name), "light");
            // The back stands behind the front as its light sees it.
            const Triangle& front = scene.triangles.at(1);
            const Triangle& back = scene.triangles.at(2);
            EXPECT_LT(
                dot(scene.vertices[back.v0].position - scene.vertices[front.v0].position, directions[0]),
                0.0f);
        }
    }
}

/// Two tetrahedra of one material, of which one is wound the other way round.
TEST(ObjLamps, ClosedSurfacesShineToTheSideThatIsSeen) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl lamp\nKe 5 5 5\n");
    std::string text = "mtllib m.mtl\nusemtl lamp\n";
    for (const int x : {0, 5}) {
        const std::string place = "v " + std::to_string(x);
        text += place + " 0 0\nv " + std::to_string(x + 1) + " 0 0\n" + place + " 1 0\n" + place + " 0 1\n";
    }
    text += "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 5 6 7\nf 5 8 6\nf 5 7 8\nf 6 8 7\n";
    const Scene outside = load_obj(files, text);
    ASSERT_EQ(outside.triangles.size(), 12u);
    for (std::size_t i = 8; i < 12; ++i) {
        EXPECT_GT(outside.vertices[outside.triangles[i].v0].position.x, 4.0f);
    }
    LoadOptions inside;
    inside.overrides.origin = {0.1, 0.1, 0.1};
    EXPECT_EQ(load_scene(files.path("m.obj"), inside).triangles.size(), 16u);
}

}  // namespace
}  // namespace nearlight::core
