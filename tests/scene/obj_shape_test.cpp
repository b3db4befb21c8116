// SPDX-License-Identifier: Apache-2.0
// The shape of OBJ scenes: polygons, normals, colours of vertices.
#include <array>
#include <cmath>

#include "host/base/math.h"
#include "tests/scene/mitsuba_text.h"
#include "tests/scene/obj_text.h"

namespace nearlight::core {
namespace {

using namespace test;

/// The area that the triangles cover in the plane z = 0, with their signs.
float signed_area(const Scene& scene) {
    float area = 0;
    for (const Triangle& t : scene.triangles) {
        const Vec3 a = scene.vertices[t.v0].position;
        area += 0.5f * cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a).z;
    }
    return area;
}

TEST(Obj, PolygonsThatAreNotConvexAreNotFilled) {
    const SceneFiles files;
    const std::string notched = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5\n";
    const Scene scene = load_obj(files, notched);
    ASSERT_EQ(scene.triangles.size(), 3u);
    EXPECT_FLOAT_EQ(signed_area(scene), 2.5f);
    for (const Triangle& t : scene.triangles) {
        const Vec3 a = scene.vertices[t.v0].position;
        EXPECT_GT(cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a).z, 0.0f);
    }
    // A shape of a Mitsuba file is the fan that Mitsuba makes of it.
    const Scene shape = files.load_xml("<shape type='obj'><string name='filename' value='m.obj'/></shape>");
    const Triangle first = shape.triangles.at(0);
    expect_near(shape.vertices[first.v2].position, {2, 2, 0});
    EXPECT_EQ(first.v0, shape.triangles.at(2).v0);
}

/// The shading normals at the corners of a triangle; a normal of 0 stands for the facet's.
std::array<Vec3, 3> corner_normals(const Scene& scene, std::size_t triangle) {
    const Triangle t = scene.triangles.at(triangle);
    return {scene.vertices[t.v0].normal, scene.vertices[t.v1].normal, scene.vertices[t.v2].normal};
}

TEST(Obj, NumbersThatCannotBeReadAreNoted) {
    const SceneFiles files;
    const std::string faces = "f 1 2 3\n";
    for (const char* line : {"v 0 1,5 0\n", "v abc 1 0\n", "v nan 1 0\n", "v 0 inf 0\n", "v 0 1\n"}) {
        const Scene scene = load_obj(files, std::string("v 0 0 0\nv 1 0 0\n") + line + "v 0 1 0\nf 1 2 4\n");
        EXPECT_TRUE(has_note(scene, "m.obj:3: `v`, `vn` or `vt` without the decimal numbers")) << line;
    }
    const Scene odd = load_obj(files, "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -nan(ind)\nvt\n" + faces);
    EXPECT_TRUE(
        has_note(odd, "m.obj:4: `v`, `vn` or `vt` without the decimal numbers that it needs, in 2 lines"));
    const Scene good =
        load_obj(files, " v +0 0. 0e-3\t# origin\nv 1 0 0 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0\nvp x\n" + faces);
    EXPECT_FALSE(has_note(good, "decimal numbers"));
}

TEST(Obj, EmptyFieldsOfFacesAreNoReferences) {
    const SceneFiles files;
    const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 -1\n";
    for (const char* face :
         {"f 1 2 3\n", "f 1// 2// 3//\n", "f 1/ 2/ 3/\n", "f 1// 2//\t3//", "f 1/ 2// 3\r\n"}) {
        const Scene scene = load_obj(files, start + face);
        ASSERT_EQ(scene.triangles.size(), 1u) << face;
        EXPECT_FALSE(has_note(scene, "refers to a normal")) << face;
        expect_near(corner_normals(scene, 0)[0], corner_normals(load_obj(files, start + "f 1 2 3\n"), 0)[0]);
    }
    for (const char* face : {"f 1 2 x\n", "f 0 1 2\n"}) {
        EXPECT_TRUE(mentions(file_error([&] { load_obj(files, start + face); }), "vertices count from 1"))
            << face;
    }
}

/// Two squares that meet at the x axis, the second one turned up by an angle.
std::string folded(float degrees, const std::string& first = "", const std::string& second = "") {
    const float angle = degrees_to_radians(degrees);
    return "v 0 0 0\nv 1 0 0\nv 0 -1 0\nv 1 -1 0\nv 0 " + std::to_string(std::cos(angle)) + " " +
           std::to_string(std::sin(angle)) + "\nv 1 " + std::to_string(std::cos(angle)) + " " +
           std::to_string(std::sin(angle)) + "\n" + first + "f 3 4 2 1\n" + second + "f 1 2 6 5\n";
}

TEST(Obj, WithoutNormalsSmallAnglesAreSmoothAndLargeOnesAreCreases) {
    const SceneFiles files;
    const Scene smooth = load_obj(files, folded(20));
    const float half = degrees_to_radians(10.0f);
    expect_near(corner_normals(smooth, 0)[2], {0, -std::sin(half), std::cos(half)});
    expect_near(corner_normals(smooth, 0)[0], {0, 0, 1});
    EXPECT_EQ(smooth.vertices.size(), 6u);
    const Scene crease = load_obj(files, folded(60));
    for (const Vec3 normal : corner_normals(crease, 0)) {
        expect_near(normal, {0, 0, 1});
    }
    EXPECT_EQ(crease.vertices.size(), 8u) << "the edge has two normals";
}

/// 0.5 and 0.6 make normals anew, whatever the file has.
TEST(Obj, ShapesOfMitsubaMayHaveAMaximumSmoothAngle) {
    const SceneFiles files;
    files.write("m.obj", folded(60));
    const auto load = [&](const std::string& more) {
        return load_scene(files.write(
            "scene.xml", "<scene version='0.6.0'>" +
                             shape("obj", "<string name='filename' value='m.obj'/>" + more) + "</scene>"));
    };
    const auto angle = [](const char* degrees) {
        return std::string("<float name='maxSmoothAngle' value='") + degrees + "'/>";
    };
    expect_near(corner_normals(load(angle("59")), 0)[2], {0, 0, 1});
    expect_near(corner_normals(load(angle("61")), 0)[2], {0, -0.5f, std::sqrt(0.75f)});
    EXPECT_TRUE(mentions(file_error([&] { load(angle("200")); }), "between 0 and 180"));
    EXPECT_TRUE(
        mentions(file_error([&] { load(angle("30") + "<boolean name='faceNormals' value='true'/>"); }),
                 "exclude each other"));
    files.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\n");
    expect_near(corner_normals(load(angle("30")), 0)[0], {0, 0, 1});
}

/// Mitsuba 0.5 and 0.6 begin a mesh at `g` and `usemtl` where faces have come before, but not at `o`.
TEST(Obj, ShapesOfOldMitsubaMayBeOneMeshOfAFile) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl a\nKd 0.1 0 0\nillum 1\nnewmtl b\nKd 0.8 0 0\nillum 1\n");
    files.write("m.obj",
                "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\ng one\nusemtl a\nf 1 2 3\n"
                "o name\nf 1 2 3\ng\nf 3 4 5\nf 3 4 5\nf 3 4 5\nusemtl b\ng three\nf 1 2 3 4\n"
                "g four\nf 1 2 9\n");
    const auto mesh = [&](const char* index) {
        return load_scene(files.write("scene.xml", "<scene version='0.6.0'>" +
                                                       shape("obj",
                                                             "<string name='filename' value='m.obj'/>"
                                                             "<integer name='shapeIndex' value='" +
                                                                 std::string(index) + "'/>") +
                                                       "</scene>"));
    };
    const auto red = [](const Scene& scene) { return front_of(scene, 0).reflectance.value.x; };
    EXPECT_EQ(mesh("0").triangles.size(), 2u);
    EXPECT_FLOAT_EQ(red(mesh("0")), 0.1f);
    const Scene second = mesh("1");
    EXPECT_EQ(second.triangles.size(), 3u);
    EXPECT_EQ(second.vertices.size(), 3u);
    EXPECT_FLOAT_EQ(red(second), 0.1f);
    EXPECT_FALSE(has_note(second, "ignored"));
    EXPECT_EQ(mesh("2").triangles.size(), 2u);
    EXPECT_FLOAT_EQ(red(mesh("2")), 0.8f);
    EXPECT_TRUE(mentions(file_error([&] { mesh("3"); }), "m.obj:20: face refers to vertex 9"));
    const std::string error = file_error([&] { mesh("4"); });
    EXPECT_TRUE(mentions(error, "scene.xml:1: ")) << error;
    EXPECT_TRUE(mentions(error, "has 4 meshes, which begin at g and usemtl, and no mesh with the index 4"));
}

TEST(Obj, ShapesOfMitsubaMayBeAllMeshesOfAFile) {
    const SceneFiles files;
    files.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng two\nf 3 2 1\nf 3 2 1\n");
    const auto load = [&](const std::string& version, const std::string& more) {
        return load_scene(files.write(
            "scene.xml", "<scene version='" + version + "'>" +
                             shape("obj", "<string name='filename' value='m.obj'/>" + more) + "</scene>"));
    };
    const std::string collapse = "<boolean name='collapse' value='true'/>";
    const std::string first = "<integer name='shapeIndex' value='0'/>";
    const std::string second = "<integer name='shapeIndex' value='1'/>";
    EXPECT_EQ(load("0.6.0", "").triangles.size(), 3u);
    EXPECT_EQ(load("0.6.0", "<integer name='shapeIndex' value='-1'/>").triangles.size(), 3u);
    EXPECT_EQ(load("0.6.0", second).triangles.size(), 2u);
    EXPECT_EQ(load("0.6.0", collapse + first).triangles.size(), 3u);
    EXPECT_TRUE(mentions(file_error([&] { load("0.6.0", collapse + second); }), "'collapse' makes one mesh"));
    const Scene recent = load("3.0.0", "<integer name='shape_index' value='1'/>");
    EXPECT_EQ(recent.triangles.size(), 3u);
    EXPECT_TRUE(has_note(recent, "unknown property 'shape_index'"));
}

TEST(Obj, SmoothingGroupsSayWhatIsSmooth) {
    const SceneFiles files;
    const Scene one = load_obj(files, folded(60, "s 1\n"));
    expect_near(corner_normals(one, 0)[2], {0, -0.5f, std::sqrt(0.75f)});
    const Scene two = load_obj(files, folded(20, "s 1\n", "s 2\n"));
    expect_near(corner_normals(two, 0)[2], {0, 0, 1});
    for (const char* const off : {"s off\n", "s 0\n"}) {
        const Scene flat = load_obj(files, folded(20, off));
        for (const Vec3 normal : corner_normals(flat, 1)) {
            expect_near(normal, {0, 0, 0});
        }
    }
    const Scene late = load_obj(files, folded(20, "", "s 1\n"));
    expect_near(corner_normals(late, 0)[0], {0, 0, 0});
    EXPECT_GT(corner_normals(late, 2)[0].z, 0.9f);
}

/// A seam in the texture is no crease.
TEST(Obj, TextureCoordinatesDoNotCutSmoothSurfaces) {
    const SceneFiles files;
    std::string text = folded(20);
    text.resize(text.find("f 3"));
    const Scene scene = load_obj(files, text + "vt 0 0\nvt 1 1\nf 3/1 4/1 2/1 1/1\nf 1/2 2/2 6/2 5/2\n");
    EXPECT_EQ(scene.vertices.size(), 8u);
    EXPECT_LT(corner_normals(scene, 0)[2].y, -0.1f);
    EXPECT_FLOAT_EQ(corner_normals(scene, 0)[2].y, corner_normals(scene, 2)[1].y);
}

/// A file may repeat a position for each face.
TEST(Obj, FacesThatMeetAtThePlaceAreSmoothToo) {
    const SceneFiles files;
    const std::string text = folded(20);
    const std::string faces = "v 0 0 0\nv 1 0 -0\nf 3 4 2 1\nf 7 8 6 5\n";
    const Scene scene = load_obj(files, text.substr(0, text.find("f 3")) + faces);
    expect_near(corner_normals(scene, 0)[2], corner_normals(scene, 2)[1]);
    EXPECT_LT(corner_normals(scene, 0)[2].y, -0.1f);
}

/// Neither a triangle without an area nor the back of a face cuts a surface in two.
TEST(Obj, OddTrianglesDoNotCutSmoothSurfaces) {
    const SceneFiles files;
    const std::string text = folded(20);
    const std::string begin = text.substr(0, text.find("f 3"));
    for (const char* const odd : {"f 1 2 2\n", "f 1 2 4 3\n"}) {
        const Scene scene = load_obj(files, begin + "f 3 4 2 1\n" + odd + "f 1 2 6 5\n");
        EXPECT_LT(corner_normals(scene, 0)[2].y, -0.1f) << odd;
    }
}

TEST(Obj, LinesMayEndWithCarriageReturns) {
    const SceneFiles files;
    files.write("r.mtl", "newmtl a\rKd 0.1 0.2 0.3\rillum 1\r");
    const Scene scene = load_obj(
        files, "mtllib r.mtl\rv 0 0 0 1 0 0\rv 1 0 0 0 1 0\rv 0 1 0 0 0 1\rs 0\rusemtl a\rf 1 2 3\r");
    EXPECT_EQ(scene.vertex_colors.size(), 3u);
    const Material side = front_of(scene, 0);
    expect_near(side.reflectance.value, {0.1f, 0.2f, 0.3f});
    expect_near(corner_normals(scene, 0)[0], {0, 0, 0});
}

/// Some editors begin UTF-8 text with such a mark.
TEST(Obj, AByteOrderMarkIsNoText) {
    const SceneFiles files;
    const std::string mark = "\xef\xbb\xbf";
    files.write("m.mtl", mark + "newmtl m\nKd 0.1 0.2 0.3\nmap_Ke no.png\nillum 1\n");
    const std::string text = mark + "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    const Scene scene = load_obj(files, text);
    const Material& side = front_of(scene, 0);
    expect_near(side.reflectance.value, {0.1f, 0.2f, 0.3f});
    EXPECT_TRUE(has_note(scene, "m.mtl:3: texture is left out"));
    EXPECT_TRUE(mentions(file_error([&] { load_obj(files, text + "f 1 2 4\n"); }), "m.obj:7: "));
    files.write("m.mtl", mark + "# Blender 4.0.2 MTL File: 'a.blend'\nnewmtl m\nKs 0.5 0.5 0.5\nillum 2\n");
    const Scene blenders = load_obj(files, text);
    EXPECT_EQ(front_of(blenders, 0).model, NEARLIGHT_BSDF_PRINCIPLED);
}

TEST(Obj, LinesMayContinue) {
    const SceneFiles files;
    const Scene scene = load_obj(files, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\r\n 3 \\\n 4\n");
    EXPECT_EQ(scene.triangles.size(), 2u);
    const std::string error = file_error([&] { load_obj(files, "v 0 0 0\nf 1 \\\n1 \\\n1\nf 1 2 3\n"); });
    EXPECT_TRUE(mentions(error, "m.obj:5: ")) << error;
}

TEST(Obj, ElementsThatAreNoFacesAreNoted) {
    const SceneFiles files;
    const std::string face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const char* const note = "m.obj: points, lines and free-form surfaces are left out";
    EXPECT_FALSE(has_note(load_obj(files, face + "# l 1 2\ns 1\ng l\n"), note));
    for (const char* element : {"l 1 2 3", " p 1", "curv 0 1 1 2", "curv2 1 2", "surf 0 1 0 1 1 2 3"}) {
        const Scene scene = load_obj(files, face + element + "\nl 1 2\n");
        EXPECT_TRUE(has_note(scene, note)) << element;
        EXPECT_EQ(scene.triangles.size(), 1u) << element;
    }
    const Scene shape = files.load_xml("<shape type='obj'><string name='filename' value='m.obj'/></shape>");
    EXPECT_FALSE(has_note(shape, "free-form")) << "Mitsuba leaves them out, too";
}

TEST(Obj, CommentsDoNotContinue) {
    const SceneFiles files;
    files.write("m.mtl", "  # File: C:\\models\\\nnewmtl a\n# a \\\r\nKd 0.1 0.2 0.3\n");
    const Scene scene = load_obj(files,
                                 "# File: C:\\models\\\nmtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf "
                                 "1 \\\n2 3\n#\\\nf 1 3 \\\n2\n");
    EXPECT_EQ(scene.triangles.size(), 2u);
    const Material side = front_of(scene, 0);
    expect_near(side.reflectance.value, {0.1f, 0.2f, 0.3f});
}

TEST(Obj, CommentsMayStandBehindNumbers) {
    const SceneFiles files;
    const Scene scene =
        load_obj(files,
                 "v 0 0 0 1 0 0 # red\nv 1 0 0 1 0 0#red\r\nv 1 1 0 1 0 0 # 5\nv 0 1 0 1 0 0\n"
                 "v 0 1 1 1 0 0\nvt 0 0 # here\nvn 0 0 1 # up\ns 1 # smooth\n"
                 "f 1/1 2/1 3/1 # a face / with a slash\n\tf 1 3 4 # 5\ns off # flat\nf 1 2 5#");
    ASSERT_EQ(scene.triangles.size(), 3u);
    EXPECT_EQ(scene.vertex_colors.size(), scene.vertices.size());
    EXPECT_FALSE(has_note(scene, "decimal numbers"));
}

TEST(Obj, NamesMayHaveTheSignOfComments) {
    const SceneFiles files;
    files.write("m#1.mtl", "newmtl a #2\nKd 0.1 0.2 0.3\n");
    const Scene scene =
        load_obj(files, "mtllib m#1.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a #2\nf 1 2 3 # a face\n");
    ASSERT_FALSE(scene.material_names.empty());
    EXPECT_EQ(scene.material_names[scene.triangles.at(0).material], "a #2");
}

TEST(Obj, TextOfWideCharactersIsNamed) {
    const SceneFiles files;
    const std::string error = file_error([&] { load_obj(files, std::string("\xff\xfev\0 \0", 6)); });
    EXPECT_TRUE(mentions(error, "UTF-16")) << error;
}

TEST(Obj, ColoursOfVerticesAreTheSurfaces) {
    const SceneFiles files;
    const Scene scene = load_obj(files, "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0.5 0.5 0.5\nf 1 2 3\n");
    ASSERT_EQ(scene.vertex_colors.size(), 3u);
    expect_near(scene.vertex_colors[0], {1, 0, 0});
    EXPECT_NEAR(scene.vertex_colors[2].x, 0.2140f, 1e-4f) << "they are sRGB";
    const Material side = front_of(scene, 0);
    ASSERT_GE(side.reflectance.texture, 0);
    EXPECT_EQ(scene.textures[static_cast<std::size_t>(side.reflectance.texture)].parameters.kind,
              NEARLIGHT_TEXTURE_VERTEX_COLOR);
    EXPECT_TRUE(load_obj(files, "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").vertex_colors.empty());
    EXPECT_TRUE(load_obj(files, "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").vertex_colors.empty())
        << "weights";
    const Scene bytes = load_obj(files, "v 0 0 0 255 0 0\nv 1 0 0 0 128 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
    expect_near(bytes.vertex_colors[0], {1, 0, 0});
    EXPECT_NEAR(bytes.vertex_colors[1].y, 0.2159f, 1e-4f);
}

}  // namespace
}  // namespace nearlight::core
