// SPDX-License-Identifier: Apache-2.0
// Checks the generated scenes: sound meshes, the documented numbers of triangles, and the same bytes every
// time.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <unordered_map>

#include "scenes/generator/scenes.h"
#include "scenes/generator/shapes.h"

namespace {

namespace fs = std::filesystem;
using namespace nearlight::core::scenes;
using nearlight::core::Vec3;

constexpr const char* kNames[] = {"cornell-box", "desk", "showcase", "stone-and-tea"};

SceneFiles make(const std::string& name) {
    if (name == "cornell-box") {
        return make_cornell_box();
    }
    if (name == "desk") {
        return make_desk();
    }
    return name == "showcase" ? make_showcase() : make_stone_and_tea(1.0f);
}

size_t count_triangles(const Model& model) {
    size_t count = 0;
    for (const auto& [part, mesh] : model.parts()) {
        count += mesh.triangles.size();
    }
    return count;
}

std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

struct PlaceHash {
    size_t operator()(const std::array<float, 3>& p) const {
        const std::hash<float> hash;
        return hash(p[0]) * 73856093u ^ hash(p[1]) * 19349663u ^ hash(p[2]) * 83492791u;
    }
};

/// Number of edges that occur in one direction more often than in the other. Corners at the same place count
/// as one, and rounding may have made an edge a point.
size_t count_open_edges(const Model& model) {
    std::unordered_map<std::array<float, 3>, std::uint32_t, PlaceHash> places;
    std::unordered_map<std::uint64_t, int> balance;
    for (const auto& [part, mesh] : model.parts()) {
        std::vector<std::uint32_t> place_of;
        for (const auto& vertex : mesh.vertices) {
            // Adding zero turns −0 into 0.
            const Vec3 p = vertex.position + Vec3{0.0f, 0.0f, 0.0f};
            place_of.push_back(
                places.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(places.size())).first->second);
        }
        for (const auto& triangle : mesh.triangles) {
            for (size_t i = 0; i < 3; ++i) {
                const std::uint64_t a = place_of[triangle[i]], b = place_of[triangle[(i + 1) % 3]];
                balance[std::min(a, b) << 32u | std::max(a, b)] += a < b ? 1 : a > b ? -1 : 0;
            }
        }
    }
    return static_cast<size_t>(
        std::ranges::count_if(balance, [](const auto& edge) { return edge.second != 0; }));
}

class SceneTest : public testing::TestWithParam<const char*> {
  protected:
    const SceneFiles scene_ = make(GetParam());
};

TEST_P(SceneTest, HasTheTrianglesItPromises) {
    const std::map<std::string, size_t> least{
        {"cornell-box", 38}, {"desk", 100'000}, {"showcase", 150'000}, {"stone-and-tea", 400'000}};
    EXPECT_GE(count_triangles(scene_.model), least.at(GetParam()));
}

TEST_P(SceneTest, MeshesAreFiniteWithUnitNormalsAndIndicesInRange) {
    for (const auto& [part, mesh] : scene_.model.parts()) {
        size_t bad_vertices = 0, bad_indices = 0;
        for (const auto& vertex : mesh.vertices) {
            const bool sound = is_finite(vertex.position) && std::isfinite(vertex.u) &&
                               std::isfinite(vertex.v) && std::abs(length(vertex.normal) - 1.0f) < 1e-4f;
            bad_vertices += sound ? 0 : 1;
        }
        for (const auto& triangle : mesh.triangles) {
            bad_indices += std::ranges::max(triangle) < mesh.vertices.size() ? 0 : 1;
        }
        EXPECT_EQ(bad_vertices, 0u) << part;
        EXPECT_EQ(bad_indices, 0u) << part;
    }
}

TEST_P(SceneTest, TrianglesFaceTheSideOfTheirNormals) {
    for (const auto& [part, mesh] : scene_.model.parts()) {
        float agreeing = 0.0f, total = 0.0f;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3 origin = mesh.vertices[a].position;
            const Vec3 area = cross(mesh.vertices[b].position - origin, mesh.vertices[c].position - origin);
            const Vec3 normal = mesh.vertices[a].normal + mesh.vertices[b].normal + mesh.vertices[c].normal;
            total += length(area);
            agreeing += dot(area, normal) > 0.0f ? length(area) : 0.0f;
        }
        EXPECT_GT(agreeing, 0.999f * total) << part;
    }
}

TEST_P(SceneTest, SurfacesAreClosed) {
    if (std::string(GetParam()) == "cornell-box") {
        GTEST_SKIP() << "the measured box is made of single sheets";
    }
    EXPECT_EQ(count_open_edges(scene_.model), 0u);
}

TEST_P(SceneTest, XmlNamesEveryFileThatIsMadeAndNoOther) {
    const fs::path folder = fs::path(NEARLIGHT_SOURCE_DIR) / "scenes" / GetParam();
    const std::string xml = bytes_of(folder / "scene.xml");
    const std::regex pattern("name=\"filename\" value=\"([^\"]+)\"");
    std::vector<std::string> named;
    for (std::sregex_iterator match(xml.begin(), xml.end(), pattern), end; match != end; ++match) {
        named.push_back((*match)[1]);
        EXPECT_TRUE(fs::exists(folder / named.back())) << named.back();
    }
    const auto is_named = [&](const std::string& file) { return std::ranges::count(named, file) > 0; };
    for (const auto& [part, mesh] : scene_.model.parts()) {
        EXPECT_TRUE(is_named("geometry/" + part + ".ply")) << part;
    }
    for (const auto& [name, bitmap] : scene_.bitmaps) {
        EXPECT_TRUE(is_named("geometry/" + name + ".ppm")) << name;
    }
    EXPECT_GE(named.size(), scene_.model.parts().size() + scene_.bitmaps.size());
}

TEST_P(SceneTest, PointLightsHangFreeInTheRoom) {
    const std::string xml = bytes_of(fs::path(NEARLIGHT_SOURCE_DIR) / "scenes" / GetParam() / "scene.xml");
    const std::regex pattern("<point name=\"position\" x=\"([^\"]+)\" y=\"([^\"]+)\" z=\"([^\"]+)\"");
    const auto& floor = scene_.model.parts().at("floor");
    const auto room = bounds(floor);
    for (std::sregex_iterator match(xml.begin(), xml.end(), pattern), end; match != end; ++match) {
        const Vec3 light{std::stof((*match)[1]), std::stof((*match)[2]), std::stof((*match)[3])};
        EXPECT_TRUE(light.x > room.min.x && light.x < room.max.x && light.z > room.min.z &&
                    light.z < room.max.z);
        float nearest = 1e9f;
        for (const auto& [part, mesh] : scene_.model.parts()) {
            for (const auto& vertex : mesh.vertices) {
                nearest = std::min(nearest, length(vertex.position - light));
            }
        }
        EXPECT_GT(nearest, 0.03f) << match->str();
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneTest, testing::ValuesIn(kNames), [](const auto& parameter) {
    std::string name = parameter.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

TEST(SceneGenerator, WritesTheSameBytesEveryTime) {
    const fs::path root = fs::temp_directory_path() / ("nearlight_scenes_test_" + std::to_string(getpid()));
    for (const char* run : {"first", "second"}) {
        const std::string command =
            std::string(NEARLIGHT_SCENES_TOOL) + " --out " + (root / run).string() + " > /dev/null";
        ASSERT_EQ(std::system(command.c_str()), 0);
    }
    size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root / "first")) {
        if (entry.is_regular_file()) {
            ++files;
            const fs::path other = root / "second" / fs::relative(entry.path(), root / "first");
            EXPECT_TRUE(bytes_of(entry.path()) == bytes_of(other)) << entry.path();
        }
    }
    EXPECT_GT(files, 80u);
    fs::remove_all(root);
}

TEST(SceneGenerator, MoreDetailMakesMoreTriangles) {
    const size_t plain = count_triangles(make_stone_and_tea(1.0f).model);
    const size_t finer = count_triangles(make_stone_and_tea(1.5f).model);
    EXPECT_GT(finer, plain + plain / 2);
}

TEST(SceneGenerator, RefusesWhatItDoesNotKnow) {
    const auto exit_code = [](const std::string& arguments) {
        const int status =
            std::system((std::string(NEARLIGHT_SCENES_TOOL) + " " + arguments + " 2> /dev/null").c_str());
        return WEXITSTATUS(status);
    };
    EXPECT_EQ(exit_code("desk"), 2);
    EXPECT_EQ(exit_code("--out /tmp no-such-scene"), 2);
    EXPECT_EQ(exit_code("--out /tmp --detail 0.1 desk"), 2);
    EXPECT_EQ(exit_code("--out /tmp --colour desk"), 2);
}

TEST(Shapes, BoxIsClosedAndHasItsSize) {
    const Mesh mesh = box({2.0f, 1.0f, 0.5f}, 0.1f, 3);
    const auto extent = bounds(mesh);
    EXPECT_NEAR(extent.min.y, 0.0f, 1e-6f);
    EXPECT_FLOAT_EQ(extent.size().x, 2.0f);
    EXPECT_FLOAT_EQ(extent.size().z, 0.5f);
    EXPECT_EQ(count_open_edges(Model("box", mesh)), 0u);
}

TEST(Shapes, OpenEdgesAreFound) {
    Mesh mesh = box({1, 1, 1}, 0.1f, 1);
    mesh.triangles.pop_back();
    EXPECT_EQ(count_open_edges(Model("box", mesh)), 3u);
}

}  // namespace
