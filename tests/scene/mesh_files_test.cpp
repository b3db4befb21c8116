// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include "host/base/half.h"
#include "host/base/thread_limit.h"
#include "host/scene/mesh.h"
#include "host/scene/ply_loader.h"
#include "tests/scene/obj_text.h"

namespace nearlight::core {
namespace {

using namespace test;

const std::string kPlyHeader =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float s\nproperty "
    "float t\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

template <typename T>
void put(std::string& out, T value, bool big) {
    std::array<char, sizeof(T)> bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big) {
        std::reverse(bytes.begin(), bytes.end());
    }
    out.append(bytes.data(), bytes.size());
}

std::string binary_ply(bool big) {
    std::string out =
        "ply\nformat binary_" + std::string(big ? "big" : "little") + "_endian 1.0\n" + kPlyHeader;
    for (const auto& v : {std::array{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
        for (const float value : {v[0], v[1], 0.0f, v[0], v[1]}) {
            put(out, value, big);
        }
    }
    out += '\4';
    for (const std::int32_t index : {0, 1, 2, 3}) {
        put(out, index, big);
    }
    return out;
}

void expect_square(const Mesh& mesh) {
    ASSERT_EQ(mesh.triangles.size(), 2u);
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles[1], (std::array<uint, 3>{0, 2, 3}));
    expect_near(mesh.positions[2], {1, 1, 0});
    EXPECT_EQ(mesh.uvs[1], (std::array<float, 2>{1, 0}));
}

TEST(Ply, TextureCoordinatesAreTheFirstWholePair) {
    const SceneFiles files;
    const auto uv_of = [&](const std::vector<std::string>& names) {
        std::string text =
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
        std::string numbers;
        for (std::size_t i = 0; i < names.size(); ++i) {
            text += "property float " + names[i] + "\n";
            numbers += " " + std::to_string(i + 1);
        }
        text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
        for (const char* position : {"0 0 0", "1 0 0", "0 1 0"}) {
            text += position + numbers + "\n";
        }
        return read_ply(files.write("uv.ply", text + "3 0 1 2\n")).uvs;
    };
    using Uv = std::array<float, 2>;
    EXPECT_EQ(uv_of({"u", "v", "s"}).at(0), (Uv{1, 2})) << "s says something else";
    EXPECT_EQ(uv_of({"t", "s", "v", "u"}).at(0), (Uv{4, 3}));
    EXPECT_EQ(uv_of({"s", "t", "texture_u", "texture_v"}).at(0), (Uv{3, 4}));
    EXPECT_EQ(uv_of({"s", "t", "u", "texture_v"}).at(0), (Uv{1, 2})) << "half a pair is none";
    EXPECT_TRUE(uv_of({"u", "t"}).empty());
}

TEST(Ply, ReadsAsciiAndBothByteOrders) {
    const SceneFiles files;
    expect_square(
        read_ply(files.write("a.ply", "ply\nformat ascii 1.0\n" + kPlyHeader +
                                          "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n")));
    expect_square(read_ply(files.write("l.ply", binary_ply(false))));
    expect_square(read_ply(files.write("b.ply", binary_ply(true))));
}

TEST(Ply, MayHaveBlanksBehindItsHeaderAndNumbersWithAPlus) {
    const SceneFiles files;
    std::string text = "ply \nformat ascii 1.0\t\n" + kPlyHeader;
    text.insert(text.rfind('\n'), " \t\r");
    expect_square(read_ply(files.write("a.ply", text + "+0 0 0 0 0\n+1.0 0 0 1 0\n1 1 +0 1 1\n0 1 0 0 1\n+4 "
                                                       "0 1 2 3\n")));
    for (const char* number : {"+-1", "++1", "+"}) {
        const auto file = files.write("b.ply", text + number + " 0 0 0 0\n");
        EXPECT_TRUE(mentions(file_error([&] { read_ply(file); }), std::string("has '") + number + "'"));
    }
}

TEST(Ply, MayHaveElementsThatSayNothing) {
    const SceneFiles files;
    const std::string start = "ply\nformat ascii 1.0\n";
    const std::string rest = kPlyHeader + "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n";
    expect_square(read_ply(files.write("a.ply", start + "element foo 0\n" + rest)));
    const auto file = files.write("b.ply", start + "element foo 1\n" + rest);
    EXPECT_TRUE(mentions(file_error([&] { read_ply(file); }), "1 times 'foo'"));
}

/// The types that Mitsuba 3 reads beside those of the format.
TEST(Ply, MayHaveHalvesAndIntegersOf64Bits) {
    const SceneFiles files;
    for (const bool big : {false, true}) {
        std::string text = "ply\nformat binary_" + std::string(big ? "big" : "little") +
                           "_endian 1.0\nelement vertex 4\nproperty half x\nproperty float16 y\n"
                           "property float z\nproperty long s\nproperty uint64 t\nelement face 1\n"
                           "property list ulong int64 vertex_indices\nend_header\n";
        for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            put(text, float_to_half(static_cast<float>(x)), big);
            put(text, float_to_half(static_cast<float>(y)), big);
            put(text, 0.0f, big);
            put(text, std::int64_t{x}, big);
            put(text, static_cast<std::uint64_t>(y), big);
        }
        put(text, std::uint64_t{4}, big);
        for (const std::int64_t index : {0, 1, 2, 3}) {
            put(text, index, big);
        }
        expect_square(read_ply(files.write("w.ply", text)));
    }
}

TEST(Ply, EveryTruncationIsAnError) {
    const SceneFiles files;
    const std::string whole = binary_ply(false);
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        const auto file = files.write("t.ply", whole.substr(0, size));
        EXPECT_TRUE(mentions(file_error([&] { read_ply(file); }), "t.ply")) << size;
    }
}

TEST(Ply, LinesThatDoNotHoldWhatTheHeaderSaysAreErrors) {
    const SceneFiles files;
    const auto read = [&](const std::string& body) {
        return read_ply(files.write("c.ply", "ply\nformat ascii 1.0\n" + kPlyHeader + body));
    };
    const auto names_line = [&](const std::string& body, const std::string& line) {
        const std::string message = file_error([&] { read(body); });
        return mentions(message, "c.ply: " + line + " does not hold what the PLY header says");
    };
    const std::string vertices = "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n";
    // The header has eleven lines.
    EXPECT_TRUE(names_line(vertices + "4 0 1 2 3 255 255 255\n", "line 16"));
    EXPECT_TRUE(names_line("0 0 0 0 0\n1 0 0 1 0 7\n1 1 0 1 1 7\n0 1 0 0 1 7\n4 0 1 2 3\n", "line 13"));
    EXPECT_TRUE(names_line("0 0 0 0\n1 0 0 1\n1 1 0 1\n0 1 0 0\n4 0 1 2 3\n", "line 12"));
    // Numbers that are all there count, however lines end between them.
    expect_square(read("0 0 0 0 0 1 0 0 1 0\n1 1 0\n1 1\n0 1 0 0 1\n4 0 1\n2 3\n"));
    expect_square(read(vertices + "4 0 1 2 3\nsome words\n"));
}

TEST(Ply, MayHaveCommentsBetweenItsRows) {
    const SceneFiles files;
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string text = "ply\nformat ascii 1.0\n" + kPlyHeader +
                           "0 0 0 0 0\n  comment 1 2\ncomment\n\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n"
                           "comment of faces\n4 0 1 2 3\ncomment";
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size()) {
            text.replace(at, 1, end);
        }
        expect_square(read_ply(files.write("c.ply", text)));
    }
}

TEST(Ply, IndicesOutOfRangeAreErrors) {
    const SceneFiles files;
    for (const char* face : {"3 0 1 4\n", "3 0 1 -1\n"}) {
        const auto file = files.write("i.ply", "ply\nformat ascii 1.0\n" + kPlyHeader +
                                                   "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n" + face);
        EXPECT_TRUE(mentions(file_error([&] { read_ply(file); }), "only 4"));
    }
}

TEST(Obj, NegativeIndicesAndPolygons) {
    const SceneFiles files;
    const Scene scene = load_obj(files, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 2 0\nv 0 1 0\nf -5 -4 -3 -2 -1\n");
    ASSERT_EQ(scene.triangles.size(), 3u);
    EXPECT_EQ(scene.vertices.size(), 5u);
    expect_near(scene.vertices[scene.triangles[2].v2].position, {0, 1, 0});
    expect_near(scene.vertices[0].normal, {0, 0, 1});
}

TEST(Obj, AVertexOutOfRangeIsAnErrorWithItsLine) {
    const SceneFiles files;
    for (const char* face : {"f 1 2 4", "f 1 2 -4", "f 1 2 0"}) {
        const std::string message = file_error(
            [&] { load_obj(files, "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n" + std::string(face) + "\n"); });
        EXPECT_TRUE(mentions(message, "m.obj:5: ")) << message;
    }
}

TEST(Obj, NanVerticesDropTheirTriangles) {
    const SceneFiles files;
    const std::string nan =
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\nnan 1 0\n3 0 1 2\n3 0 2 3\n";
    files.write("nan.ply", "ply\nformat ascii 1.0\n" + nan);
    const Scene scene = files.load_xml("<shape type='ply'><string name='filename' value='nan.ply'/></shape>");
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_TRUE(has_note(scene, "nan.ply: 1 triangles with NaN"));
    for (const Vertex& vertex : scene.vertices) {
        EXPECT_TRUE(is_finite(vertex.position));
    }
}

TEST(Obj, GetsACameraThatSeesEverythingAndALight) {
    const SceneFiles files;
    const Scene scene = load_obj(files, "v -3 0 -1\nv 5 0 2\nv 0 4 0\nf 1 2 3\n");
    EXPECT_TRUE(scene.delta_emitters.empty());
    EXPECT_GT(scene.environment.width, 1);
    const Mat4 to_camera = inverse(scene.camera.to_world);
    const float tan_x = std::tan(degrees_to_radians(static_cast<float>(scene.camera.fov_x_degrees) / 2));
    const float tan_y =
        tan_x * static_cast<float>(scene.camera.height) / static_cast<float>(scene.camera.width);
    for (const Vertex& vertex : scene.vertices) {
        const Vec3 p = transform_point(to_camera, vertex.position);
        EXPECT_GT(p.z, 0.0f);
        EXPECT_LE(std::abs(p.x), tan_x * p.z);
        EXPECT_LE(std::abs(p.y), tan_y * p.z);
    }
}

TEST(Obj, MissingAndEmptyFiles) {
    const SceneFiles files;
    EXPECT_TRUE(mentions(file_error([&] { load_scene(files.path("no.obj")); }), "no such"));
    EXPECT_TRUE(mentions(file_error([&] { load_scene(files.path("")); }), "folder"));
    EXPECT_TRUE(mentions(file_error([&] { load_scene(files.write("a.fbx", "x")); }), "unknown scene format"));
    for (const char* const text : {"", "v 0 0 0\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n"}) {
        EXPECT_TRUE(mentions(file_error([&] { load_obj(files, text); }), "no triangles")) << text;
    }
}

TEST(Mesh, SmoothNormalsAreWeightedByAngle) {
    // At a right-angled edge one side is cut into two triangles at the corner, and both sides have the same
    // weight.
    const std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<std::array<uint, 3>> t{{0, 1, 2}, {0, 2, 3}, {0, 4, 1}};
    const std::vector<Vec3> n = smooth_normals(p, t);
    expect_near(n[0], normalize(Vec3{0, 1, 1}));
    expect_near(n[2], {0, 0, 1});
}

/// Files are read ahead by other threads, of which the scene must show nothing.
TEST(Obj, ManyFilesOfASceneComeInItsOrder) {
    const SceneFiles files;
    std::string body;
    for (int i = 0; i < 40; ++i) {
        std::string text = "v " + std::to_string(i) + " 0 0\nv " + std::to_string(i) + " 1 0\nv 0 0 1\n";
        for (int face = 0; face < (i % 3 == 0 ? 500 : 1); ++face) {  // some take longer
            text += "f 1 2 3\n";
        }
        const std::string name = "m" + std::to_string(i) + (i == 7 ? ".obj" : "_.obj");
        files.write(name, text + (i == 20 ? "f 1 2\n" : ""));
        const std::string shape =
            "<shape type='obj'><string name='filename' value='" + name + "'/></shape>\n";
        body += i % 5 == 4   ? "<shape type='rectangle'/>\n" + shape
                : i % 7 == 6 ? "<shape type='merge'>" + shape + "</shape>\n"
                             : shape;
    }
    for (const int threads : {0, 1}) {
        const ThreadLimit limit(threads);
        const Scene scene = files.load_xml(body);
        std::vector<float> xs;
        for (const ObjectRun& run : scene.objects) {
            if (scene.object_names[run.name].find("rectangle") == std::string::npos) {
                xs.push_back(scene.vertices[scene.triangles[run.first_triangle].v0].position.x);
            }
        }
        ASSERT_EQ(xs.size(), 40u);
        for (std::size_t i = 0; i < xs.size(); ++i) {
            EXPECT_EQ(xs[i], static_cast<float>(i));
        }
        EXPECT_TRUE(has_note(scene, "m20_.obj: 1 faces with fewer than three corners are left out"));
    }
    // What is wrong first in the scene is what one is told, wherever the threads are.
    files.write("m7.obj", "v 0 0 0\nf 1 2 3\n");
    files.write("m8_.obj", "nothing");
    const std::string error = file_error([&] { files.load_xml(body); });
    EXPECT_TRUE(mentions(error, "m7.obj:2: face refers to vertex 2")) << error;
    EXPECT_TRUE(mentions(error, "scene.xml:11: ")) << error;
}

TEST(Obj, CornersDoWithoutNormalsAndCoordinatesThatAreNotThere) {
    const SceneFiles files;
    const Scene scene = load_scene(files.write("a.obj",
                                               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\n"
                                               "f 1//1 2//1 3//1\nf 2/1/2 4/-1/3 3/1/-9\n"));
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_TRUE(has_note(scene, "a.obj:7: face refers to a normal or texture coordinate that is not there"));
    const auto normal = [&](const Triangle& triangle) { return scene.vertices[triangle.v0].normal; };
    expect_near(normal(scene.triangles[0]), {0, 0, 1});
    // A corner without a normal is shaded with that of its triangle.
    expect_near(normal(scene.triangles[1]), {0, 0, 0});
}

TEST(Obj, CommentsMayStandBehindNamesOfMaterials) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl Red\nKd 1 0 0\nnewmtl Red # 2\nKd 0 1 0\n");
    const Scene scene = load_obj(files,
                                 "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Red  # a # b\nf 1 2 3\n"
                                 "usemtl Red # 2\nf 1 2 3\nusemtl Blue # c\nf 1 2 3\n");
    const auto color = [&](std::size_t triangle) { return front_of(scene, triangle).reflectance.value; };
    expect_near(color(0), {1, 0, 0});
    expect_near(color(1), {0, 1, 0});
    EXPECT_EQ(scene.material_names.at(scene.triangles[0].material), "Red");
    EXPECT_TRUE(has_note(scene, "m.obj:9: material 'Blue # c' is not defined"));
}

}  // namespace
}  // namespace nearlight::core
