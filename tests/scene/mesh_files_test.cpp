// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>

#include "host/base/thread_limit.h"
#include "host/scene/mesh.h"
#include "host/scene/obj_loader.h"
#include "host/scene/obj_text.h"
#include "host/scene/ply_loader.h"
#include "tests/scene/scene_files.h"

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

TEST(Ply, ReadsAsciiAndBothByteOrders) {
    const SceneFiles files;
    expect_square(
        read_ply(files.write("a.ply", "ply\nformat ascii 1.0\n" + kPlyHeader +
                                          "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n")));
    expect_square(read_ply(files.write("l.ply", binary_ply(false))));
    expect_square(read_ply(files.write("b.ply", binary_ply(true))));
}

TEST(Ply, MayHaveElementsThatSayNothing) {
    const SceneFiles files;
    const std::string start = "ply\nformat ascii 1.0\n";
    const std::string rest = kPlyHeader + "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n";
    expect_square(read_ply(files.write("a.ply", start + "element foo 0\n" + rest)));
    const auto file = files.write("b.ply", start + "element foo 1\n" + rest);
    EXPECT_TRUE(mentions(file_error([&] { read_ply(file); }), "1 times 'foo'"));
}

TEST(Ply, EveryTruncationIsAnError) {
    const SceneFiles files;
    const std::string whole = binary_ply(false);
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        const auto file = files.write("t.ply", whole.substr(0, size));
        EXPECT_TRUE(mentions(file_error([&] { read_ply(file); }), "t.ply")) << size;
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

Scene load_obj(const SceneFiles& files, const std::string& text) {
    return load_scene(files.write("m.obj", text));
}

TEST(Obj, NegativeIndicesAndPolygons) {
    const SceneFiles files;
    const Scene scene = load_obj(files, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 2 0\nv 0 1 0\nf -5 -4 -3 -2 -1\n");
    ASSERT_EQ(scene.triangles.size(), 3u);
    EXPECT_EQ(scene.vertices.size(), 5u);
    expect_near(scene.vertices[scene.triangles[2].v2].position, {0, 1, 0});
    expect_near(scene.vertices[0].normal, {0, 0, 1});
}

TEST(Obj, AnIndexOutOfRangeIsAnErrorWithItsLine) {
    const SceneFiles files;
    for (const char* face : {"f 1 2 4", "f 1 2 -4", "f 1 2 0", "f 1/1 2/1 3/1", "f 1//2 2//2 3//2"}) {
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

TEST(Obj, MaterialsLightsAndMissingOnes) {
    const SceneFiles files;
    files.write(
        "my lib.mtl",
        "newmtl red wall\nKd 0.8 0.1 0.1\nillum 1\nnewmtl red roof \nKd 0.2 0 0\nnewmtl lamp\nKd 0 0 0\nKe 5 "
        "6 7\n"
        "newmtl paper\nKd 1 1 1\nmap_Kd gone.png\nnewmtl veil\nd 0.1\nnewmtl mirror\nillum 5\nKs 1 1 1\n"
        "newmtl pane\nillum 4\n");
    std::string text = "mtllib my lib.mtl\nmtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char* name : {"red wall", "lamp", "paper", "nobody", "veil", "mirror", "red roof", "pane"}) {
        text += std::string("usemtl ") + name + "\nf 1 2 3\n";
    }
    const Scene scene = load_obj(files, text);
    ASSERT_EQ(scene.triangles.size(), 9u);
    const auto material = [&](std::size_t i) { return scene.materials[scene.triangles[i].material]; };
    const auto side = [&](std::size_t i) {
        EXPECT_EQ(material(i).model, NEARLIGHT_BSDF_TWO_SIDED);
        EXPECT_EQ(material(i).child[0], material(i).child[1]);
        return scene.materials[material(i).child[0]];
    };
    expect_near(side(0).reflectance.value, {0.5f, 0.5f, 0.5f});
    expect_near(side(1).reflectance.value, {0.8f, 0.1f, 0.1f});
    expect_near(material(2).emission.value, {5, 6, 7});
    expect_near(side(3).reflectance.value, {0.5f, 0.5f, 0.5f});
    EXPECT_EQ(material(5).model, NEARLIGHT_BSDF_MASK);
    EXPECT_FLOAT_EQ(material(5).reflectance.value.x, 0.1f);
    EXPECT_EQ(scene.materials[material(5).child[0]].model, NEARLIGHT_BSDF_TWO_SIDED);
    EXPECT_EQ(side(6).model, NEARLIGHT_BSDF_CONDUCTOR);
    expect_near(side(7).reflectance.value, {0.2f, 0, 0});
    EXPECT_EQ(material(8).model, NEARLIGHT_BSDF_THIN_DIELECTRIC);
    EXPECT_TRUE(has_note(scene, "m.obj:2: material library 'missing.mtl'"));
    EXPECT_TRUE(has_note(scene, "my lib.mtl:11: texture is replaced"));
    EXPECT_TRUE(has_note(scene, "m.obj:13: material 'nobody'"));
    EXPECT_TRUE(scene.delta_emitters.empty());
}

// The material on both sides of the only triangle, with this text as the entry of the library.
Material only_material(const SceneFiles& files, const std::string& entry, Scene* scene = nullptr) {
    files.write("m.mtl", "newmtl m\n" + entry);
    const Scene loaded = load_obj(files, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    if (scene != nullptr) {
        *scene = loaded;
    }
    return loaded.materials[loaded.materials[loaded.triangles.at(0).material].child[0]];
}

TEST(Obj, HighlightsAreRoughPlastic) {
    const SceneFiles files;
    const Material plastic = only_material(files, "Kd 0.5 0.4 0.3\nKs 0.2 0.3 0.4\nNs 98\nNi 1.6\nillum 2\n");
    EXPECT_EQ(plastic.model, NEARLIGHT_BSDF_PLASTIC);
    expect_near(plastic.reflectance.value, {0.5f, 0.4f, 0.3f});
    expect_near(plastic.specular.value, {0.2f, 0.3f, 0.4f});
    EXPECT_NEAR(plastic.roughness.value.x, std::sqrt(2.0 / 100.0), 1e-6);
    EXPECT_FLOAT_EQ(plastic.eta.x, 1.6f);
    EXPECT_NE(plastic.flags & NEARLIGHT_MATERIAL_BECKMANN, 0u);
    EXPECT_FLOAT_EQ(only_material(files, "Ks 0.5 0.5 0.5\nNs 10\nNi 1\n").eta.x, 1.5f);
    for (const char* matt : {"Kd 1 1 1\nKs 0.5 0.5 0.5\nillum 1\n", "Kd 1 1 1\nKs 0 0 0\nNs 50\nillum 2\n"}) {
        EXPECT_EQ(only_material(files, matt).model, NEARLIGHT_BSDF_DIFFUSE) << matt;
    }
    Scene scene;
    EXPECT_EQ(only_material(files, "Ks 1 1 1\nNs -5\nmap_Ks gone.png\nmap_Ns gone.png\n", &scene).model,
              NEARLIGHT_BSDF_PLASTIC);
    EXPECT_TRUE(has_note(scene, "m.mtl:4: texture is replaced"));
    EXPECT_TRUE(has_note(scene, "map_Ns"));
}

TEST(Obj, RoughnessAndMetalnessArePrincipled) {
    const SceneFiles files;
    const Material metal =
        only_material(files, "Kd 0.9 0.6 0.2\nKs 0.5 0.5 0.5\nNs 30\nPr 0.3\nPm 1\nillum 3\n");
    EXPECT_EQ(metal.model, NEARLIGHT_BSDF_PRINCIPLED);
    expect_near(metal.reflectance.value, {0.9f, 0.6f, 0.2f});
    EXPECT_FLOAT_EQ(metal.roughness.value.x, 0.3f);
    EXPECT_FLOAT_EQ(metal.metallic.value.x, 1.0f);
    EXPECT_FLOAT_EQ(only_material(files, "Kd 1 1 1\nPr 7\n").roughness.value.x, 1.0f);
    Scene scene;
    only_material(files, "Kd 1 1 1\nPm 0.5\nPs 0.3\nPc 0.2\n", &scene);
    EXPECT_TRUE(has_note(scene, "m.mtl:1: sheen, clear coat"));
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
    EXPECT_TRUE(mentions(file_error([&] { load_scene(files.path("")); }), "directory"));
    EXPECT_TRUE(mentions(file_error([&] { load_scene(files.write("a.fbx", "x")); }), "unknown scene format"));
    for (const char* const text : {"", "v 0 0 0\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n"}) {
        EXPECT_TRUE(mentions(file_error([&] { load_obj(files, text); }), "no triangles")) << text;
    }
}

TEST(Obj, LinesOfWhatIsLeftOut) {
    const SceneFiles files;
    files.write("m.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\n\nmap_Kd no.png\nnewmtl c\nmap_Kd no2.png\n");
    const Scene scene =
        load_obj(files,
                 "mtllib m.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\n"
                 "f 1/1 2/1 3/1\nusemtl b\nf 1/1 2/1 3/1\nusemtl d\nf 1/1 2/1 3/1\n");
    const auto line_of = [&](const std::string& text) {
        const auto note =
            std::ranges::find_if(scene.notes, [&](const Note& n) { return mentions(n.text, text); });
        return note == scene.notes.end() ? -1 : note->line;
    };
    EXPECT_EQ(line_of("gone.mtl"), 2);
    EXPECT_EQ(line_of("'d' is not defined"), 11);
    EXPECT_EQ(line_of("no.png"), 5);
}

TEST(Obj, LinesOfABlockThatIsNotThere) {
    const std::string text = "newmtl a\nillum 2\nnewmtl b\nillum 4\n";
    const auto line = [&](const TextLine& first, const std::string& value) {
        return find_in_block(text, first, "newmtl", "illum", value);
    };
    const auto blocks = lines_by_value(text, "newmtl");
    EXPECT_EQ(line(blocks.at("b"), "4"), 4);
    EXPECT_EQ(line(blocks.at("a"), "4"), 0) << "it is in the next block";
    EXPECT_EQ(line({}, "2"), 0);
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

}  // namespace
}  // namespace nearlight::core
