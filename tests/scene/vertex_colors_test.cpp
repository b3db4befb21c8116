// SPDX-License-Identifier: Apache-2.0
#include "host/scene/vertex_colors.h"

#include "host/scene/texture.h"
#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

/// A triangle in a PLY file whose corners are red, green and twice blue.
void write_colored_triangle(const SceneFiles& files, const std::string& names = "r g b") {
    const std::string r = names.substr(0, names.find(' '));
    const std::string g = names.substr(r.size() + 1, names.rfind(' ') - r.size() - 1);
    const std::string b = names.substr(names.rfind(' ') + 1);
    files.write("mesh.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                "z\nproperty float " +
                    r + "\nproperty float " + g + "\nproperty float " + b +
                    "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                    "0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 2\n3 0 1 2\n");
}

std::string attribute_bsdf(const std::string& scale = "0.5") {
    return "<bsdf type='diffuse'><texture type='mesh_attribute' name='reflectance'><string name='name' "
           "value='vertex_color'/><float name='scale' value='" +
           scale + "'/></texture></bsdf>";
}

const std::string kPly = "<string name='filename' value='mesh.ply'/>";

TEST(VertexColors, ComeFromPlyFiles) {
    const SceneFiles files;
    for (const char* names : {"r g b", "red green blue"}) {
        write_colored_triangle(files, names);
        const Scene scene = files.load_xml(shape("ply", kPly + attribute_bsdf()));
        ASSERT_EQ(scene.vertex_colors.size(), scene.vertices.size());
        expect_near(scene.vertex_colors[1], {0, 1, 0});
        expect_near(scene.vertex_colors[2], {0, 0, 2});
        const Parameter& reflectance = scene.materials.at(0).reflectance;
        expect_near(parameter_value(scene, reflectance, 0, 0, scene.vertex_colors[2]), {0, 0, 1});
        EXPECT_FALSE(has_note(scene, "colours of vertices"));
    }
}

TEST(VertexColors, AreDroppedIfNothingAsksForThem) {
    const SceneFiles files;
    write_colored_triangle(files);
    EXPECT_TRUE(files.load_xml(shape("ply", kPly)).vertex_colors.empty());
}

TEST(VertexColors, MissingOnesAreWhiteWithANote) {
    const SceneFiles files;
    write_colored_triangle(files);
    for (const std::string& body : {shape("cube", attribute_bsdf()) + shape("ply", kPly),
                                    shape("ply", kPly) + shape("cube", attribute_bsdf())}) {
        const Scene scene = files.load_xml(body);
        ASSERT_EQ(scene.vertex_colors.size(), scene.vertices.size());
        EXPECT_TRUE(has_note(scene, "the mesh has none; white is used"));
        for (const Vec3 color : scene.vertex_colors) {
            EXPECT_GE(std::min({color.x, color.y, color.z}), 0.0f);
        }
    }
    // The same colours on a mesh that has them, beside one that asks for none.
    const Scene good = files.load_xml(shape("cube") + shape("ply", kPly + attribute_bsdf()));
    EXPECT_FALSE(has_note(good, "white is used"));
}

TEST(VertexColors, AboveOneAreNoted) {
    const SceneFiles files;
    write_colored_triangle(files);
    EXPECT_TRUE(has_note(files.load_xml(shape("ply", kPly + attribute_bsdf("1"))), "above 1"));
}

}  // namespace
}  // namespace nearlight::core
