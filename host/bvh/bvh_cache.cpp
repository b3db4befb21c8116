// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/bvh_cache.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <system_error>

#include "host/base/atomic_file.h"
#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/bvh/flatten.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

/// Must change whenever the builder makes other trees or the format of files changes.
constexpr std::uint64_t kVersion = 6;
constexpr const char* kExtension = ".tree";

Hash128 key_of(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes) {
    Hasher key;
    key.add(kVersion);
    key.add(static_cast<int>(config.quality));
    key.add(config.bin_count);
    key.add(config.max_leaf_triangles);
    key.add(config.traversal_cost);
    key.add(config.intersection_cost);
    key.add(config.max_duplication);
    key.add(shapes.binary);
    key.add(shapes.wide);
    std::vector<std::uint8_t> glass;
    for (const Material& material : scene.materials) {
        glass.push_back(is_glass(material) ? 1 : 0);
    }
    key.add_array(glass);
    key.add_array(scene.vertices);
    key.add_array(scene.triangles);
    return key.hash128();
}

/// The start of a file, which the arrays of both trees follow.
struct Header {
    std::array<char, 8> magic{'N', 'L', 'T', 'R', 'E', 'E', '0', '1'};
    Hash128 key{};
    Hash128 checksum{};  ///< hash of the rest of the header and of what follows
    struct Tree {
        std::uint64_t nodes = 0, triangles = 0, wide_nodes = 0, block_columns = 0;
        double sah_cost = 0;
        std::int64_t depth = 0;
    };
    Tree opaque{}, glass{};
    std::uint64_t has_glass = 0;
};

Header::Tree describe(const ShapedBvh& tree) {
    return {tree.binary.nodes.size(), tree.binary.triangle_ids.size(),
            tree.wide.nodes.size(),   tree.wide.triangle_ids.size(),
            tree.binary.sah_cost,     tree.binary.depth};
}

/// The size in a file of the arrays of one tree.
std::uint64_t array_bytes(const Header::Tree& tree) {
    return tree.nodes * sizeof(BvhNode) + tree.wide_nodes * sizeof(WideNode) +
           (tree.triangles + tree.block_columns) * sizeof(uint);
}

/// Calls visit(array) for all arrays of a file, in their order. Triangles are not among them, because the
/// scene has them.
template <typename Trees, typename Visitor>
void for_each_array(Trees& trees, const Visitor& visit) {
    for (auto* tree : {&trees.opaque, &trees.glass}) {
        visit(tree->binary.nodes), visit(tree->binary.triangle_ids);
        visit(tree->wide.nodes), visit(tree->wide.triangle_ids);
    }
}

Hash128 checksum_of(Header header, const SceneTrees& trees) {
    header.checksum = {};
    Hasher sum;
    sum.add(header);
    for_each_array(trees, [&](const auto& values) { sum.add_array(std::span(values)); });
    return sum.hash128();
}

ShapedBvh room_for(const Header::Tree& tree) {
    ShapedBvh result;
    result.binary.nodes.resize(tree.nodes);
    result.binary.triangle_ids.resize(tree.triangles);
    result.binary.sah_cost = tree.sah_cost;
    result.binary.depth = static_cast<int>(tree.depth);
    result.wide.nodes.resize(tree.wide_nodes);
    result.wide.triangle_ids.resize(tree.block_columns);
    return result;
}

std::optional<SceneTrees> read(const fs::path& path, const Hash128& key, const Scene& scene) {
    std::ifstream file(path, std::ios::binary);
    Header header;
    const Header expected;
    std::error_code ignored;
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != expected.magic ||
        header.key != key ||
        sizeof header + array_bytes(header.opaque) + array_bytes(header.glass) !=
            fs::file_size(path, ignored)) {
        return std::nullopt;
    }
    SceneTrees trees{room_for(header.opaque), room_for(header.glass), header.has_glass != 0};
    for_each_array(trees, [&](auto& values) {
        const auto bytes = std::as_writable_bytes(std::span(values));
        file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    });
    if (!file || checksum_of(header, trees) != header.checksum) {
        return std::nullopt;
    }
    for (ShapedBvh* tree : {&trees.opaque, &trees.glass}) {
        fetch_triangles(tree->binary, scene);
        fetch_blocks(tree->wide, scene);
    }
    return trees;
}

void write(const fs::path& path, const Hash128& key, const SceneTrees& trees) {
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    AtomicFile result(path);
    std::ofstream file(result.temporary(), std::ios::binary);
    Header header;
    header.key = key;
    header.opaque = describe(trees.opaque);
    header.glass = describe(trees.glass);
    header.has_glass = trees.has_glass ? 1 : 0;
    header.checksum = checksum_of(header, trees);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    for_each_array(trees, [&](const auto& values) {
        const auto bytes = std::as_bytes(std::span(values));
        file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    });
    file.close();
    if (file) {
        ignored = result.commit(Durability::cache);
    }
}

/// Removes the least recently used trees until the rest fits.
void shrink(const fs::path& folder, std::uintmax_t max_bytes) {
    struct File {
        fs::path path;
        fs::file_time_type used;
        std::uintmax_t bytes;
    };
    std::error_code ignored;
    std::vector<File> files;
    std::uintmax_t sum = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        if (entry.path().extension() == kExtension) {
            files.push_back({entry.path(), entry.last_write_time(ignored), entry.file_size(ignored)});
            sum += files.back().bytes;
        }
    }
    std::ranges::sort(files, {}, &File::used);
    for (auto file = files.begin(); file != files.end() && sum > max_bytes; ++file) {
        fs::remove(file->path, ignored);
        sum -= file->bytes;
    }
}

}  // namespace

SceneTrees find_or_build_scene_trees(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes,
                                     const BvhCacheConfig& cache) {
    if (cache.folder.empty() || cache.folder == "none" || scene.triangles.size() < cache.min_triangles) {
        return build_scene_trees(scene, config, shapes);
    }
    const Hash128 key = key_of(scene, config, shapes);
    const fs::path path = cache.folder / (hex_digits(key[0]) + kExtension);
    if (std::optional<SceneTrees> kept = read(path, key, scene)) {
        std::error_code ignored;
        fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
        say_debug("trees taken from " + path.string());
        return std::move(*kept);
    }
    SceneTrees trees = build_scene_trees(scene, config, shapes);
    write(path, key, trees);
    shrink(cache.folder, cache.max_bytes);
    return trees;
}

}  // namespace nearlight::core
