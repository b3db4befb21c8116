// SPDX-License-Identifier: Apache-2.0
#include "host/scene/vertex_colors.h"

#include <array>

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

/// Two triangles of four vertices with a colour and a weight for each vertex and face.
void write_attributes(const SceneFiles& files) {
    const std::string channels =
        "property float color_0\nproperty float color_1\nproperty float color_2\n"
        "property float weight_0\nproperty float pair_0\nproperty float pair_1\n";
    files.write("mesh.ply",
                "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
                "z\n" +
                    channels + "element face 2\nproperty list uchar int vertex_indices\n" + channels +
                    "end_header\n"
                    "0 0 0 1 0 0 0.1 5 5\n1 0 0 0 1 0 0.2 5 5\n1 1 0.5 0 0 1 0.3 5 5\n0 1 0 1 1 1 0.4 5 5\n"
                    "3 0 1 2 0.5 0.25 0.125 0.75 5 5\n3 0 2 3 0.2 0.4 0.8 0.5 5 5\n");
}

std::string attribute(const std::string& parameter, const std::string& name) {
    return "<texture type='mesh_attribute' name='" + parameter + "'><string name='name' value='" + name +
           "'/></texture>";
}

TEST(VertexColors, AreTheAttributeThatIsAskedFor) {
    const SceneFiles files;
    write_attributes(files);
    const auto load = [&](const std::string& bsdf) { return files.load_xml(shape("ply", kPly + bsdf)); };
    const Scene colors = load("<bsdf type='diffuse'>" + attribute("reflectance", "vertex_color") + "</bsdf>");
    ASSERT_EQ(colors.vertex_colors.size(), 4u);
    expect_near(colors.vertex_colors[2], {0, 0, 1});
    const Scene weights = load("<bsdf type='blendbsdf'>" + attribute("weight", "vertex_weight") +
                               "<bsdf type='diffuse'/><bsdf type='plastic'/></bsdf>");
    ASSERT_EQ(weights.vertex_colors.size(), 4u);
    expect_near(weights.vertex_colors[3], {0.4f, 0.4f, 0.4f});
    const Material& blend = weights.materials.at(weights.triangles.at(0).material);
    EXPECT_NEAR(parameter_number(weights, blend.reflectance, 0, 0, weights.vertex_colors[3]), 0.4f, 1e-6f);
    const Scene two = load("<bsdf type='diffuse'>" + attribute("reflectance", "vertex_pair") + "</bsdf>");
    EXPECT_TRUE(has_note(two, "colours of vertices, but the mesh has none"));
}

/// The facets keep the normals that they share.
TEST(VertexColors, OfFacesGiveEachTriangleItsOwnVertices) {
    const SceneFiles files;
    write_attributes(files);
    const Scene smooth = files.load_xml(shape("ply", kPly));
    const auto load = [&](const std::string& name) {
        return files.load_xml(
            shape("ply", kPly + "<bsdf type='diffuse'>" + attribute("reflectance", name) + "</bsdf>"));
    };
    const Scene scene = load("face_color");
    ASSERT_EQ(scene.triangles.size(), 2u);
    ASSERT_EQ(scene.vertices.size(), 6u);
    ASSERT_EQ(scene.vertex_colors.size(), 6u);
    const Scene weights = load("face_weight");
    for (std::size_t i = 0; i < 2; ++i) {
        const Triangle& triangle = scene.triangles[i];
        const Triangle& shared = smooth.triangles[i];
        const std::array<std::array<uint, 2>, 3> corners{
            {{triangle.v0, shared.v0}, {triangle.v1, shared.v1}, {triangle.v2, shared.v2}}};
        for (const auto& [own, common] : corners) {
            expect_near(scene.vertex_colors[own],
                        i == 0 ? Vec3{0.5f, 0.25f, 0.125f} : Vec3{0.2f, 0.4f, 0.8f});
            expect_near(weights.vertex_colors[own], Vec3{1, 1, 1} * (i == 0 ? 0.75f : 0.5f));
            expect_near(scene.vertices[own].position, smooth.vertices[common].position);
            expect_near(scene.vertices[own].normal, smooth.vertices[common].normal);
        }
    }
}

TEST(VertexColors, HaveTheOrderOfTheirNames) {
    const SceneFiles files;
    for (const char* names : {"b g r", "blue green red"}) {
        write_colored_triangle(files, names);
        const Scene scene = files.load_xml(shape("ply", kPly + attribute_bsdf()));
        ASSERT_EQ(scene.vertex_colors.size(), 3u);
        expect_near(scene.vertex_colors[0], {0, 0, 1});
        expect_near(scene.vertex_colors[2], {2, 0, 0});
    }
}

/// Mitsuba 3 expects numbers from 0 to 1, and warns of integers, but takes them as they are.
TEST(VertexColors, OfIntegerTypesCountAsTheyStand) {
    const SceneFiles files;
    for (const char* type : {"uchar", "ushort", "float"}) {
        files.write("mesh.ply",
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nproperty " +
                        std::string(type) +
                        " heat_0\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                        "0 0 0 128\n1 0 0 128\n0 1 0 128\n3 0 1 2\n");
        const Scene scene = files.load_xml(shape(
            "ply", kPly + "<bsdf type='diffuse'>" + attribute("reflectance", "vertex_heat") + "</bsdf>"));
        expect_near(scene.vertex_colors.at(0), Vec3{128, 128, 128});
    }
}

/// Its property `srgb`, which is true unless the file says otherwise, holds for all colours.
TEST(VertexColors, OfMitsuba06AreSrgbUnlessTheShapeSaysOtherwise) {
    const SceneFiles files;
    const auto color = [&](const std::string& type, const std::string& numbers, const std::string& srgb) {
        std::string channels;
        for (const char* channel : {"red", "green", "blue"}) {
            channels += "property " + type + " " + channel + "\n";
        }
        files.write("mesh.ply",
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\n" +
                        channels +
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " +
                        numbers + "\n1 0 0 " + numbers + "\n0 1 0 " + numbers + "\n3 0 1 2\n");
        const Scene scene = load_scene(
            files.write("old.xml", "<scene version='0.6.0'>" +
                                       shape("ply", kPly + srgb +
                                                        "<bsdf type='diffuse'><texture type='vertexcolors' "
                                                        "name='reflectance'/></bsdf>") +
                                       "</scene>"));
        EXPECT_FALSE(has_note(scene, "ignored"));
        return scene.vertex_colors.at(0);
    };
    const std::string is_linear = "<boolean name='srgb' value='false'/>";
    expect_near(color("uchar", "255 128 0", ""), {1, 0.2158605f, 0});
    expect_near(color("float", "1 0.5 0", ""), {1, 0.2140411f, 0});
    expect_near(color("uchar", "255 51 0", is_linear), {1, 0.2f, 0});
    expect_near(color("float", "1 0.5 0", is_linear), {1, 0.5f, 0});
}

TEST(VertexColors, TwoAttributesOfAMeshAreRefused) {
    const SceneFiles files;
    write_attributes(files);
    const std::string message = file_error([&] {
        files.load_xml(shape("ply", kPly + "<bsdf type='blendbsdf'>" + attribute("weight", "face_weight") +
                                        "<bsdf type='diffuse'>" + attribute("reflectance", "vertex_color") +
                                        "</bsdf><bsdf type='diffuse'/></bsdf>"));
    });
    EXPECT_TRUE(mentions(message, "'face_weight' and 'vertex_color'")) << message;
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
