// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/serialized_mesh.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/scene/mitsuba_text.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

template <typename... Numbers>
std::string bytes(Numbers... numbers) {
    std::string text;
    const auto put = [&](auto number) {
        char raw[sizeof(number)];
        std::memcpy(raw, &number, sizeof(number));
        text.append(raw, sizeof(number));
    };
    (put(numbers), ...);
    return text;
}

/// A zlib stream whose only block is not compressed [RFC 1950, RFC 1951].
std::string zlib_stream(const std::string& data) {
    std::uint32_t a = 1;
    std::uint32_t b = 0;
    for (const char c : data) {
        a = (a + static_cast<unsigned char>(c)) % 65521;
        b = (b + a) % 65521;
    }
    const auto length = static_cast<std::uint16_t>(data.size());
    std::string text = "\x78\x01\x01" + bytes(length, static_cast<std::uint16_t>(~length)) + data;
    for (const std::uint32_t part : {b >> 8, b, a >> 8, a}) {
        text += static_cast<char>(part & 255u);
    }
    return text;
}

std::string header(std::uint16_t version) {
    return bytes(std::uint16_t{0x041c}, version);
}

/// A triangle whose third corner is (0, height, 0), with normals along −Z and texture coordinates.
std::string triangle(int version, double height, bool is_double) {
    std::string data = bytes(std::uint32_t{is_double ? 0x200bu : 0x1003u});
    if (version == 4) {
        data += std::string("name") + '\0';
    }
    data += bytes(std::uint64_t{3}, std::uint64_t{1});
    const auto put = [&](double number) {
        data += is_double ? bytes(number) : bytes(static_cast<float>(number));
    };
    for (const double number : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, height, 0.0}) {
        put(number);
    }
    for (const double number : {0.0, 0.0, -1.0, 0.0, 0.0, -1.0, 0.0, 0.0, -1.0}) {
        put(number);
    }
    for (const double number : {0.0, 0.25, 1.0, 0.25, 0.0, 1.0}) {
        put(number);
    }
    for (int i = 0; is_double && i < 9; ++i) {
        put(0.125 * i);  // colours
    }
    return zlib_stream(data + bytes(std::uint32_t{0}, std::uint32_t{1}, std::uint32_t{2}));
}

TEST(SerializedMesh, EveryMeshOfAFileCanBeRead) {
    const SceneFiles files;
    const std::string first = header(4) + triangle(4, 2.0, false);
    const std::string second = header(4) + triangle(4, 3.0, true);
    files.write("two.serialized",
                first + second + bytes(std::uint64_t{0}, std::uint64_t{first.size()}, std::uint32_t{2}));
    const auto load = [&](const std::string& body) {
        return files.load_xml(shape("serialized", "<string name='filename' value='two.serialized'/>" + body));
    };
    const Scene scene = load("");
    ASSERT_EQ(scene.triangles.size(), 1u);
    expect_near(bounds(scene).max, {1, 2, 0});
    // The front is the side of the normals, and v is counted from the top row.
    const Triangle t = scene.triangles[0];
    const Vec3 a = scene.vertices[t.v0].position;
    EXPECT_LT(cross(scene.vertices[t.v1].position - a, scene.vertices[t.v2].position - a).z, 0.0f);
    EXPECT_FLOAT_EQ(scene.vertices[0].v, 0.75f);
    expect_near(bounds(load("<integer name='shape_index' value='1'/>")).max, {1, 3, 0});
    EXPECT_TRUE(
        mentions(file_error([&] { load("<integer name='shape_index' value='2'/>"); }), "has 2 meshes"));
}

TEST(SerializedMesh, OldAndNewVersions) {
    const SceneFiles files;
    const Mesh old =
        mitsuba::read_serialized(files.write("old.serialized", header(3) + triangle(3, 5.0, false)), 0);
    ASSERT_EQ(old.positions.size(), 3u);
    expect_near(old.positions[2], {0, 5, 0});

    std::string data = bytes(std::uint32_t{0x1015}, std::uint32_t{1}) + "x";  // normals, uvs, flat facets
    data += bytes(std::uint64_t{3}, std::uint64_t{1}, std::uint64_t{0}, std::uint64_t{0});
    for (int i = 0; i < 3; ++i) {
        data += bytes(float(i), 2.0f * float(i * i), 0.0f, 0.0f, 0.0f, 1.0f, 0.5f, 0.25f * float(i));
    }
    data += bytes(std::uint32_t{2}, std::uint32_t{1}, std::uint32_t{0}, std::uint32_t{0}, std::uint32_t{0});
    const Mesh recent =
        mitsuba::read_serialized(files.write("new.serialized", header(5) + zlib_stream(data)), 0);
    expect_near(recent.positions.at(2), {2, 8, 0});
    expect_near(recent.normals.at(2), {0, 0, 1});
    EXPECT_FLOAT_EQ(recent.uvs.at(2)[1], 0.5f);
    EXPECT_EQ(recent.triangles.at(0), (std::array<uint, 3>{2, 1, 0}));
    EXPECT_TRUE(recent.face_normals);
}

TEST(SerializedMesh, ColoursAndFlatFacetsAreThoseOfTheFile) {
    const SceneFiles files;
    const auto read = [&](const std::string& text) {
        return mitsuba::read_serialized(files.write("a.serialized", header(4) + text), 0);
    };
    EXPECT_FALSE(read(triangle(4, 1.0, true)).face_normals);
    EXPECT_TRUE(read(triangle(4, 1.0, false)).colors.empty());
    const Mesh colored = read(triangle(4, 1.0, true));
    ASSERT_EQ(colored.colors.size(), 3u);
    expect_near(colored.colors[1], {0.375f, 0.5f, 0.625f});

    std::string data = bytes(std::uint32_t{0x1010}, '\0', std::uint64_t{3}, std::uint64_t{1});
    data += bytes(0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f);
    data += bytes(std::uint32_t{0}, std::uint32_t{1}, std::uint32_t{2});
    EXPECT_TRUE(read(zlib_stream(data)).face_normals);
}

/// Mitsuba 3 does not look at the flag of flat facets, which 0.5 and 0.6 heed.
TEST(SerializedMesh, OnlyOldScenesHaveTheFlatFacetsOfAFile) {
    const SceneFiles files;
    std::string data = bytes(std::uint32_t{0x1011}, '\0', std::uint64_t{3}, std::uint64_t{1});
    data += bytes(0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f);
    for (int i = 0; i < 3; ++i) {
        data += bytes(0.6f, 0.0f, 0.8f);
    }
    data += bytes(std::uint32_t{0}, std::uint32_t{1}, std::uint32_t{2});
    files.write("flat.serialized", header(4) + zlib_stream(data));
    const auto normal = [&](const std::string& version, const std::string& body) {
        const std::string text =
            shape("serialized", "<string name='filename' value='flat.serialized'/>" + body);
        const Scene scene =
            load_scene(files.write("scene.xml", "<scene version='" + version + "'>" + text + "</scene>"));
        return scene.vertices.at(0).normal;
    };
    expect_near(normal("3.0.0", ""), {0.6f, 0, 0.8f});
    expect_near(normal("0.6.0", ""), {0, 0, 0});
    expect_near(normal("3.0.0", "<boolean name='face_normals' value='true'/>"), {0, 0, 0});
}

TEST(SerializedMesh, TexturesLookUpColoursOfVertices) {
    const SceneFiles files;
    files.write("a.serialized", header(4) + triangle(4, 1.0, true));
    const auto load = [&](const std::string& name) {
        return files.load_xml(
            shape("serialized",
                  "<string name='filename' value='a.serialized'/><bsdf type='diffuse'>"
                  "<texture type='mesh_attribute' name='reflectance'><string name='name' value='" +
                      name + "'/></texture></bsdf>"));
    };
    const Scene scene = load("vertex_color");
    ASSERT_EQ(scene.vertex_colors.size(), 3u);
    expect_near(scene.vertex_colors[1], {0.375f, 0.5f, 0.625f});
    EXPECT_TRUE(has_note(load("vertex_heat"), "the mesh has none")) << "the file has no such attribute";
}

TEST(SerializedMesh, BrokenFilesAreRefused) {
    const SceneFiles files;
    const std::string good = header(4) + triangle(4, 2.0, false);
    const auto error = [&](const std::string& text) {
        return file_error([&] { mitsuba::read_serialized(files.write("bad.serialized", text), 0); });
    };
    EXPECT_TRUE(mentions(error("ply\n"), "not a serialized mesh"));
    EXPECT_TRUE(mentions(error("x"), "truncated"));
    EXPECT_TRUE(mentions(error(header(9) + "x"), "version 9"));
    EXPECT_TRUE(mentions(error(header(4) + "no stream"), "broken"));
    for (std::size_t size = 4; size < good.size(); size += 7) {
        error(good.substr(0, size));
    }
    const auto promise = [](std::uint64_t vertices) {
        return header(4) +
               zlib_stream(bytes(std::uint32_t{0x1000}) + '\0' + bytes(vertices, std::uint64_t{1}));
    };
    EXPECT_TRUE(mentions(error(promise(~std::uint64_t{0})), "more vertices"));
    EXPECT_TRUE(mentions(error(promise(0xffffffffu)), "the file is truncated"))
        << "and takes no memory before";
    std::string changed = good;
    changed.back() = static_cast<char>(changed.back() ^ 1);
    EXPECT_TRUE(mentions(error(changed), "broken")) << "the checksum is another one";
}

TEST(MitsubaMerge, MergedShapesAreThere) {
    const SceneFiles files;
    const Scene scene =
        files.load_xml(shape("merge", shape("rectangle") + shape("cube", to_world("<translate x='3'/>"))));
    EXPECT_EQ(scene.triangles.size(), 14u);
    EXPECT_FLOAT_EQ(bounds(scene).max.x, 4.0f);
}

}  // namespace
}  // namespace nearlight::core
