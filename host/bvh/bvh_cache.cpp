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
constexpr std::uint64_t kVersion = 7;
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
    key.add_array(scene.vertices);
    key.add_array(scene.triangles);
    return key.hash128();
}

/// The start of a file, which the arrays of the tree follow.
struct Header {
    std::array<char, 8> magic{'N', 'L', 'T', 'R', 'E', 'E', '0', '1'};
    Hash128 key{};
    Hash128 checksum{};  ///< hash of the rest of the header and of what follows
    std::uint64_t nodes = 0, triangles = 0, wide_nodes = 0, block_columns = 0;
    double sah_cost = 0;
    std::int64_t depth = 0;
};

Header describe(const ShapedBvh& tree) {
    Header header;
    header.nodes = tree.binary.nodes.size();
    header.triangles = tree.binary.triangle_ids.size();
    header.wide_nodes = tree.wide.nodes.size();
    header.block_columns = tree.wide.triangle_ids.size();
    header.sah_cost = tree.binary.sah_cost;
    header.depth = tree.binary.depth;
    return header;
}

/// Whether a file of that size can hold what the header promises, and nothing else.
bool is_whole(const Header& header, std::uint64_t file_size) {
    const std::array counts{header.nodes, header.wide_nodes, header.triangles, header.block_columns};
    // No product of a number that is less than the file's size overflows.
    return std::ranges::max(counts) <= file_size &&
           sizeof header + header.nodes * sizeof(BvhNode) + header.wide_nodes * sizeof(WideNode) +
                   (header.triangles + header.block_columns) * sizeof(uint) ==
               file_size;
}

/// Calls visit(array) for all arrays of a file, in their order. Triangles are not among them, because the
/// scene has them.
template <typename Tree, typename Visitor>
void for_each_array(Tree& tree, const Visitor& visit) {
    visit(tree.binary.nodes), visit(tree.binary.triangle_ids);
    visit(tree.wide.nodes), visit(tree.wide.triangle_ids);
}

Hash128 checksum_of(Header header, const ShapedBvh& tree) {
    header.checksum = {};
    Hasher sum;
    sum.add(header);
    for_each_array(tree, [&](const auto& values) { sum.add_array(std::span(values)); });
    return sum.hash128();
}

ShapedBvh room_for(const Header& header) {
    ShapedBvh result;
    result.binary.nodes.resize(header.nodes);
    result.binary.triangle_ids.resize(header.triangles);
    result.binary.sah_cost = header.sah_cost;
    result.binary.depth = static_cast<int>(header.depth);
    result.wide.nodes.resize(header.wide_nodes);
    result.wide.triangle_ids.resize(header.block_columns);
    return result;
}

std::optional<ShapedBvh> read(const fs::path& path, const Hash128& key, const Scene& scene) {
    std::ifstream file(path, std::ios::binary);
    Header header;
    const Header expected;
    std::error_code ignored;
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != expected.magic ||
        header.key != key || !is_whole(header, fs::file_size(path, ignored))) {
        return std::nullopt;
    }
    ShapedBvh tree = room_for(header);
    for_each_array(tree, [&](auto& values) {
        const auto bytes = std::as_writable_bytes(std::span(values));
        file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    });
    if (!file || checksum_of(header, tree) != header.checksum) {
        return std::nullopt;
    }
    fetch_triangles(tree.binary, scene);
    fetch_blocks(tree.wide, scene);
    return tree;
}

void write(const fs::path& path, const Hash128& key, const ShapedBvh& tree) {
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    AtomicFile result(path);
    std::ofstream file(result.temporary(), std::ios::binary);
    Header header = describe(tree);
    header.key = key;
    header.checksum = checksum_of(header, tree);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    for_each_array(tree, [&](const auto& values) {
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
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
        std::error_code gone;  // another process may have removed the file
        const std::uintmax_t bytes = entry->file_size(gone);
        if (!gone && entry->path().extension() == kExtension) {
            files.push_back({entry->path(), entry->last_write_time(ignored), bytes});
            sum += bytes;
        }
    }
    std::ranges::sort(files, {}, &File::used);
    for (auto file = files.begin(); file != files.end() && sum > max_bytes; ++file) {
        fs::remove(file->path, ignored);
        sum -= file->bytes;
    }
}

}  // namespace

ShapedBvh find_or_build_scene_tree(const Scene& scene, const BvhConfig& config, const TreeShapes& shapes,
                                   const BvhCacheConfig& cache) {
    if (cache.folder.empty() || cache.folder == "none" || scene.triangles.size() < cache.min_triangles) {
        return build_scene_tree(scene, config, shapes);
    }
    const Hash128 key = key_of(scene, config, shapes);
    const fs::path path = cache.folder / (hex_digits(key[0]) + kExtension);
    if (std::optional<ShapedBvh> kept = read(path, key, scene)) {
        std::error_code ignored;
        fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
        say_debug("tree taken from " + path.string());
        return std::move(*kept);
    }
    ShapedBvh tree = build_scene_tree(scene, config, shapes);
    write(path, key, tree);
    shrink(cache.folder, cache.max_bytes);
    return tree;
}

}  // namespace nearlight::core
