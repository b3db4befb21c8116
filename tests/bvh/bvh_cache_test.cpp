// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/bvh_cache.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "host/scene/material_model.h"
#include "tests/bvh/soup.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

class BvhCache : public testing::Test {
  protected:
    BvhCache() {
        scene_.materials.push_back(dielectric_material(1.5));
        for (std::size_t i = 0; i < scene_.triangles.size(); i += 5) {
            scene_.triangles[i].material = 1;
        }
    }
    ShapedBvh get(const BvhConfig& config = {}) const {
        return find_or_build_scene_tree(
            scene_, config, shapes_, {.folder = folder_.path(), .min_triangles = 1, .max_bytes = max_bytes_});
    }
    void expect_right(const ShapedBvh& tree, const BvhConfig& config = {}) const {
        const Bvh built = build_scene_bvh(scene_, config);
        const Bvh binary = shapes_.binary ? built : Bvh{};
        EXPECT_TRUE(test::same_bits(tree.binary.nodes, binary.nodes));
        EXPECT_TRUE(test::same_bits(tree.binary.triangles, binary.triangles));
        EXPECT_EQ(tree.binary.triangle_ids, binary.triangle_ids);
        EXPECT_EQ(tree.binary.sah_cost, binary.sah_cost);
        EXPECT_EQ(tree.binary.depth, binary.depth);
        const WideBvh wide = shapes_.wide ? widen(built) : WideBvh{};
        EXPECT_TRUE(test::same_bits(tree.wide.nodes, wide.nodes));
        EXPECT_TRUE(test::same_bits(tree.wide.blocks, wide.blocks));
        EXPECT_EQ(tree.wide.triangle_ids, wide.triangle_ids);
    }
    [[nodiscard]] std::filesystem::path only_file() const {
        return std::filesystem::directory_iterator(folder_.path())->path();
    }

    TemporaryFolder folder_;
    Scene scene_ = test::random_soup(600, 0.3f, 5);
    TreeShapes shapes_{.binary = true, .wide = true};
    std::uintmax_t max_bytes_ = 1u << 30u;
};

TEST_F(BvhCache, GivesWhatWouldBeBuilt) {
    const BvhConfig quality{.quality = BvhQuality::quality};
    for (const BvhConfig& config : {BvhConfig{}, quality}) {
        expect_right(get(config), config);
        expect_right(get(config), config);
    }
    EXPECT_EQ(folder_.file_count(), 2u);
}

TEST_F(BvhCache, KeepsTheShapesThatAreWanted) {
    for (const TreeShapes& shapes : {TreeShapes{.binary = true}, TreeShapes{.wide = true}}) {
        shapes_ = shapes;
        expect_right(get());
        expect_right(get());
    }
    EXPECT_EQ(folder_.file_count(), 2u);
}

TEST_F(BvhCache, ReallyReadsTheFile) {
    get();
    const auto before = std::filesystem::last_write_time(only_file()) - std::chrono::hours(1);
    std::filesystem::last_write_time(only_file(), before);
    get();
    EXPECT_GT(std::filesystem::last_write_time(only_file()), before) << "not marked as used";
    EXPECT_EQ(folder_.file_count(), 1u);
}

TEST_F(BvhCache, AnotherSceneHasAnotherTree) {
    get();
    scene_.vertices[17].position.x += 1e-3f;
    expect_right(get());
    scene_.triangles[3].material = 1;
    expect_right(get());
    std::swap(scene_.triangles[5], scene_.triangles[6]);
    expect_right(get());
    scene_.triangles.pop_back();
    expect_right(get());
    EXPECT_EQ(folder_.file_count(), 5u);
}

TEST_F(BvhCache, WithoutGlassToo) {
    for (Triangle& triangle : scene_.triangles) {
        triangle.material = 0;
    }
    get();
    expect_right(get());
}

TEST_F(BvhCache, DamagedFilesAreBuiltAgain) {
    get();
    const std::filesystem::path file = only_file();
    std::ifstream stream(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    for (std::size_t i = 0; i < whole.size(); i += i < 200 ? 1 : 997) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 1);
        std::ofstream(file, std::ios::binary) << (i % 2 == 0 ? damaged : whole.substr(0, i));
        expect_right(get());
    }
    std::ofstream(file, std::ios::binary) << whole + "more";
    expect_right(get());
}

TEST_F(BvhCache, ForgetsWhatWasNotUsedForLongest) {
    get();
    const std::filesystem::path first = only_file();
    std::filesystem::last_write_time(first, std::filesystem::last_write_time(first) - std::chrono::hours(1));
    max_bytes_ = std::filesystem::file_size(first) * 3 / 2;
    get({.quality = BvhQuality::quality});
    EXPECT_EQ(folder_.file_count(), 1u);
    EXPECT_FALSE(std::filesystem::exists(first));
}

TEST_F(BvhCache, KeepsNothingWhereThereIsNoFolderOrLittleToBuild) {
    for (const char* folder : {"", "none"}) {
        expect_right(find_or_build_scene_tree(scene_, {}, shapes_, {.folder = folder, .min_triangles = 1}));
    }
    expect_right(find_or_build_scene_tree(scene_, {}, shapes_, {.folder = folder_.path()}));
    EXPECT_EQ(folder_.file_count(), 0u);
    EXPECT_FALSE(std::filesystem::exists("none"));
}

}  // namespace
}  // namespace nearlight::core
