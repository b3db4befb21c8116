// SPDX-License-Identifier: Apache-2.0
// PLY files as whole scenes.
#include <gtest/gtest.h>

#include <bit>

#include "host/image/image_io.h"
#include "host/scene/places.h"
#include "host/scene/texture.h"
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

TEST(PlyScene, LinesOfTheHeaderMayEndInAnyWay) {
    const SceneFiles files;
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string file =
            "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
            "property float y\nproperty float z\n" +
            kFace;
        for (std::size_t at = 0; (at = file.find('\n', at)) != std::string::npos; at += end.size()) {
            file.replace(at, 1, end);
        }
        // The first coordinate begins with the byte of a line feed, which is not to be taken for one.
        const float positions[] = {std::bit_cast<float>(0x3f80000au), 0, 0, 2, 0, 0, 1, 1, 0};
        const int face[] = {0, 1, 2};
        file.append(reinterpret_cast<const char*>(positions), sizeof positions);
        file.push_back(3);
        file.append(reinterpret_cast<const char*>(face), sizeof face);
        EXPECT_EQ(load_scene(files.write("a.ply", file)).vertices.at(0).position.x, positions[0]);
    }
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
    expect_near(first_color("ushort", "65535 32896 0"), {1, 0.2158605f, 0}, 1e-4f);
    expect_near(first_color("int", "255 128 0"), {1, 0.2158605f, 0}, 1e-4f);
    expect_near(first_color("uchar", "1 1 0"), Vec3{1, 1, 0} / (255 * 12.92f), 1e-6f);
    expect_near(first_color("float", "1 0.5 0"), {1, 0.2140411f, 0}, 1e-4f);
    EXPECT_GT(first_color("float", "1.001 0.5 0").y, 0.2f) << "a little over 1 makes no bytes of them";
}

/// Writes an image of a left and a right texel, as an sRGB-encoded file has them: grey 0.25 and 0.75 before
/// they are encoded.
void write_scan(const SceneFiles& files, const std::string& name, float left = 0.25f, float right = 0.75f) {
    write_image(files.path(name), {2, 1, {"R", "G", "B"}, {left, left, left, right, right, right}});
}

/// The red that the surface of a triangle has at a corner.
float red_at(const Scene& scene, std::size_t triangle, std::size_t corner) {
    const Triangle& t = scene.triangles.at(triangle);
    const Vertex& vertex = scene.vertices.at(corner == 0 ? t.v0 : corner == 1 ? t.v1 : t.v2);
    const Parameter& reflectance = scene.materials.at(scene.materials.at(t.material).child[0]).reflectance;
    return parameter_value(scene, reflectance, vertex.u, vertex.v).x;
}

TEST(PlyScene, ATextureThatACommentNamesIsOnTheSurface) {
    const SceneFiles files;
    write_scan(files, "my scan.png");
    std::string header = kHeader;
    header.insert(header.find("element"), "comment made by hand\ncomment TextureFile my scan.png\n");
    for (const std::string names : {"s t", "u v", "texture_u texture_v"}) {
        const std::string uv = "property float " + names.substr(0, names.find(' ')) + "\nproperty float " +
                               names.substr(names.find(' ') + 1) + "\n";
        const Scene scene = load_scene(files.write(
            "t.ply", header + uv + kFace + "0 0 0 0.25 0.5\n1 0 0 0.75 0.5\n0 1 0 0.5 0.5\n3 0 1 2\n"));
        ASSERT_EQ(scene.images.size(), 1u);
        EXPECT_EQ(scene.images[0].format, NEARLIGHT_TEXELS_SRGB8);
        EXPECT_NEAR(red_at(scene, 0, 0), 0.25f, 0.01f);
        EXPECT_NEAR(red_at(scene, 0, 1), 0.75f, 0.01f);
        EXPECT_NEAR(red_at(scene, 0, 2), 0.5f, 0.01f) << "between texels";
        EXPECT_FALSE(has_note(scene, "texture"));
    }
    const Scene bare = load_scene(files.write("b.ply", header + kFace + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    EXPECT_TRUE(has_note(bare, "b.ply: the texture 'my scan.png' is left out, because the file has no"));
    EXPECT_TRUE(bare.images.empty());
}

/// Two triangles with an edge in common, as MeshLab writes their texture coordinates.
std::string wedge_header(const std::string& comments, const std::string& more = "") {
    return "ply\nformat ascii 1.0\n" + comments +
           "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + more +
           "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n";
}
const std::string kScan = "comment TextureFile scan.png\n";
const std::string kWedgeVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const std::string kLeftFace = "3 0 1 2 6 0.25 0 0.25 1 0.25 0.5";
const std::string kRightFace = "3 0 2 3 6 0.75 0 0.75 1 0.75 0.5";

TEST(PlyScene, CornersOfFacesMayHaveTextureCoordinatesOfTheirOwn) {
    const SceneFiles files;
    write_scan(files, "scan.png");
    const Scene scene =
        load_scene(files.write("w.ply", wedge_header(kScan) + "end_header\n" + kWedgeVertices + kLeftFace +
                                            "\n" + kRightFace + "\n"));
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.vertices.size(), 6u);
    const std::array<std::array<Vec3, 3>, 2> places{
        {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}, {{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}}}};
    for (std::size_t triangle = 0; triangle < 2; ++triangle) {
        const Triangle& t = scene.triangles[triangle];
        const std::array vertices{t.v0, t.v1, t.v2};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            EXPECT_NEAR(red_at(scene, triangle, corner), triangle == 0 ? 0.25f : 0.75f, 0.01f);
            expect_near(scene.vertices[vertices[corner]].position, places[triangle][corner]);
            expect_near(scene.vertices[vertices[corner]].normal, {0, 0, 1});
        }
        EXPECT_EQ(scene.vertices[t.v1].v, 1.0f);
    }
    EXPECT_FALSE(has_note(scene, "texture"));
    // Where corners agree, their triangles go on sharing a vertex.
    const Scene shared =
        load_scene(files.write("s.ply", wedge_header(kScan) + "end_header\n" + kWedgeVertices +
                                            "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n"));
    EXPECT_EQ(shared.vertices.size(), 4u);
}

TEST(PlyScene, FacesMayHaveDifferentTextures) {
    const SceneFiles files;
    write_scan(files, "scan.png");
    write_scan(files, "dark.png", 0.125f, 0.125f);
    const std::string both = kScan + "comment TextureFile dark.png\n";
    const std::string numbered = wedge_header(both) + "property int texnumber\nend_header\n" + kWedgeVertices;
    const Scene scene = load_scene(files.write("n.ply", numbered + kLeftFace + " 0\n" + kRightFace + " 1\n"));
    EXPECT_EQ(scene.images.size(), 2u);
    EXPECT_NEAR(red_at(scene, 0, 0), 0.25f, 0.01f);
    EXPECT_NEAR(red_at(scene, 1, 0), 0.125f, 0.01f);
    EXPECT_FALSE(has_note(scene, "texture"));
    for (const std::string& second :
         {kRightFace + " -1\n", kRightFace + " 2\n", std::string("3 0 2 3 0 0\n")}) {
        const Scene part = load_scene(files.write("p.ply", numbered + kLeftFace + " 0\n" + second));
        EXPECT_NEAR(red_at(part, 0, 0), 0.25f, 0.01f);
        EXPECT_FLOAT_EQ(red_at(part, 1, 0), 0.5f) << "grey without a texture";
        EXPECT_EQ(part.images.size(), 1u);
    }
    const Scene unnumbered =
        load_scene(files.write("u.ply", wedge_header(both) + "end_header\n" + kWedgeVertices + kLeftFace +
                                            "\n" + kRightFace + "\n"));
    EXPECT_NEAR(red_at(unnumbered, 1, 0), 0.75f, 0.01f);
    EXPECT_TRUE(has_note(unnumbered, "names 2 textures, but its faces do not say which one they have"));
}

TEST(PlyScene, ATextureThatCannotBeReadIsNoted) {
    const SceneFiles files;
    const std::string faces = kLeftFace + "\n" + kRightFace + "\n";
    const auto grey = files.write("g.ply", wedge_header(kScan) + "end_header\n" + kWedgeVertices + faces);
    EXPECT_TRUE(
        has_note(load_scene(grey), "g.ply: texture is replaced by mid-grey because it cannot be read"));
    EXPECT_FLOAT_EQ(red_at(load_scene(grey), 0, 0), 0.5f);
    EXPECT_TRUE(mentions(file_error([&] { load_scene(grey, {.strict = true}); }), "scan.png"));
    std::string channels;
    for (const char* channel : {"red", "green", "blue"}) {
        channels += "property uchar " + std::string(channel) + "\n";
    }
    const auto colored = files.write("c.ply", wedge_header(kScan, channels) +
                                                  "end_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n"
                                                  "1 1 0 255 0 0\n0 1 0 255 0 0\n" +
                                                  faces);
    const Scene colors = load_scene(colored);
    EXPECT_TRUE(has_note(colors, "the colours of vertices are used in its place"));
    expect_near(colors.vertex_colors.at(0), {1, 0, 0});
    write_scan(files, "scan.png");
    const Scene both = load_scene(colored);
    EXPECT_TRUE(has_note(both, "a texture and colours of vertices"));
    EXPECT_NEAR(red_at(both, 0, 0), 0.25f, 0.01f);
    EXPECT_TRUE(both.vertex_colors.empty());
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

TEST(PlyScene, FacesMayStandBeforeTheirVertices) {
    const SceneFiles files;
    const std::string faces = "element face 2\nproperty list uchar int vertex_indices\n";
    const std::string vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    const auto load = [&](const std::string& body) {
        return load_scene(
            files.write("f.ply", "ply\nformat ascii 1.0\n" + faces + vertices + "end_header\n" + body));
    };
    const Scene scene = load("3 0 1 2\n3 0 2 3\n" + kWedgeVertices);
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.triangles[1].v2, 3u);
    EXPECT_TRUE(mentions(file_error([&] { load("3 0 1 2\n3 0 2 4\n" + kWedgeVertices); }), "only 4"));
}

/// Two strips in one list: a square of two triangles, then one triangle. A corner that stands twice turns the
/// next triangle round once more.
TEST(PlyScene, StripsOfTrianglesAreRead) {
    const SceneFiles files;
    const auto load = [&](const std::string& strip) {
        std::string header = kHeader;
        header.replace(header.find("vertex 3"), 8, "vertex 4");
        return load_scene(files.write("s.ply", header +
                                                   "element tristrips 1\nproperty list int int "
                                                   "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 "
                                                   "0\n" +
                                                   strip));
    };
    const Scene scene = load("8 0 1 2 3 -1 2 1 3\n");
    ASSERT_EQ(scene.triangles.size(), 3u);
    const auto normal = [&](const Scene& of, std::size_t triangle) {
        const Triangle& t = of.triangles.at(triangle);
        const Vec3 a = of.vertices[t.v0].position;
        return normalize(cross(of.vertices[t.v1].position - a, of.vertices[t.v2].position - a));
    };
    for (std::size_t triangle = 0; triangle < 3; ++triangle) {
        expect_near(normal(scene, triangle), {0, 0, 1});
    }
    EXPECT_EQ(load("6 0 1 2 2 1 3\n").triangles.size(), 2u);
    EXPECT_TRUE(mentions(file_error([&] { load("3 0 1 -2\n"); }), "vertex -2"));
}

TEST(PlyScene, FacesMayHaveColours) {
    const SceneFiles files;
    const std::string channels = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const auto load = [&](const std::string& of_vertices, const std::string& color) {
        std::string body;
        for (const char* vertex : {"0 0 0", "1 0 0", "1 1 0", "0 1 0"}) {
            body += std::string(vertex) + color + "\n";
        }
        return load_scene(
            files.write("f.ply",
                        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                        "property float z\n" +
                            of_vertices + "element face 2\nproperty list uchar int vertex_indices\n" +
                            channels + "end_header\n" + body + "3 0 1 2 255 0 0\n3 0 2 3 0 128 255\n"));
    };
    const auto color = [](const Scene& scene, std::size_t triangle) {
        EXPECT_GE(only_side(scene).reflectance.texture, 0);
        return scene.vertex_colors.at(scene.triangles.at(triangle).v0);
    };
    const Scene scene = load("", "");
    expect_near(color(scene, 0), {1, 0, 0});
    expect_near(color(scene, 1), {0, 0.2158605f, 1}, 1e-4f);
    EXPECT_EQ(scene.vertices.size(), 6u);
    EXPECT_FALSE(has_note(scene, "colours"));
    const Scene both = load(channels, " 0 255 0");
    expect_near(color(both, 0), {0, 1, 0});
    EXPECT_TRUE(has_note(both, "those of vertices are used"));
}

}  // namespace
}  // namespace nearlight::core
