// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/bvh_cache.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>

#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/bvh/flatten.h"
#include "host/bvh/parallel.h"

namespace nearlight {
namespace {

namespace fs = std::filesystem;

/// To be changed whenever the builder makes other trees, or files look different.
constexpr std::uint64_t kVersion = 5;
constexpr const char* kExtension = ".tree";

using Key = std::array<std::uint64_t, 2>;

/// Of 8 bytes at a time: byte by byte it would take as long as reading a tree.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t word, std::uint64_t factor) {
    hash = (hash ^ word) * factor;
    return hash ^ (hash >> 29u);
}

Key hash_part(std::span<const std::byte> bytes) {
    Key hash{0x9e3779b97f4a7c15ull, 0xc2b2ae3d27d4eb4full};
    const auto add = [&](std::uint64_t word) {
        hash = {mixed(hash[0], word, 0xff51afd7ed558ccdull), mixed(hash[1], word, 0xc4ceb9fe1a85ec53ull)};
    };
    while (!bytes.empty()) {
        std::uint64_t word = 0;
        const std::size_t count = std::min(bytes.size(), sizeof word);
        std::memcpy(&word, bytes.data(), count);
        add(word);
        bytes = bytes.subspan(count);
    }
    return hash;
}

template <typename T>
void add_to(Key& key, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const Key hash = hash_part(std::as_bytes(std::span(&value, 1)));
    key = {mixed(key[0], hash[0], 0xff51afd7ed558ccdull), mixed(key[1], hash[1], 0xc4ceb9fe1a85ec53ull)};
}

/// In parts of fixed length, so that threads may share the work.
template <typename T>
void add_to(Key& key, const std::vector<T>& values) {
    constexpr std::size_t kPart = 1u << 18u;
    const auto bytes = std::as_bytes(std::span(values));
    std::vector<Key> parts((bytes.size() + kPart - 1) / kPart);
    parallel_for(parts.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            parts[i] = hash_part(bytes.subspan(i * kPart, std::min(kPart, bytes.size() - i * kPart)));
        }
    });
    add_to(key, bytes.size());
    for (const Key& part : parts) {
        add_to(key, part);
    }
}

Key key_of(const Scene& scene, const BvhConfig& config) {
    Key key{};
    add_to(key, kVersion);
    add_to(key, static_cast<int>(config.quality));
    add_to(key, config.bin_count);
    add_to(key, config.max_leaf_triangles);
    add_to(key, config.traversal_cost);
    add_to(key, config.intersection_cost);
    add_to(key, config.max_duplication);
    std::vector<std::uint8_t> glass;
    for (const Material& material : scene.materials) {
        glass.push_back(is_glass(material) ? 1 : 0);
    }
    add_to(key, glass);
    add_to(key, scene.vertices);
    add_to(key, scene.triangles);
    return key;
}

/// At the start of a file; both trees' nodes and triangle ids follow.
struct Header {
    std::array<char, 8> magic{'N', 'L', 'T', 'R', 'E', 'E', '0', '1'};
    Key key{};
    Key checksum{};  ///< of the header without it, and of what follows
    struct Tree {
        std::uint64_t nodes = 0, triangles = 0;
        double sah_cost = 0;
        std::int64_t depth = 0;
    };
    Tree opaque{}, glass{};
    std::uint64_t has_glass = 0;

    [[nodiscard]] std::uint64_t file_size() const {
        return sizeof(Header) + (opaque.nodes + glass.nodes) * sizeof(BvhNode) +
               (opaque.triangles + glass.triangles) * sizeof(uint);
    }
};

Key checksum_of(Header header, const SceneBvhs& bvhs) {
    header.checksum = {};
    Key key{};
    add_to(key, header);
    for (const Bvh* bvh : {&bvhs.opaque, &bvhs.glass}) {
        add_to(key, bvh->nodes);
        add_to(key, bvh->triangle_ids);
    }
    return key;
}

template <typename T>
void read_array(std::istream& file, std::vector<T>& values, std::uint64_t count) {
    values.resize(count);
    file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
}
template <typename T>
void write_array(std::ostream& file, const std::vector<T>& values) {
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(T)));
}

void read_tree(std::istream& file, const Header::Tree& tree, Bvh& bvh) {
    read_array(file, bvh.nodes, tree.nodes);
    read_array(file, bvh.triangle_ids, tree.triangles);
    bvh.sah_cost = tree.sah_cost;
    bvh.depth = static_cast<int>(tree.depth);
}

std::optional<SceneBvhs> read(const fs::path& path, const Key& key, const Scene& scene) {
    std::ifstream file(path, std::ios::binary);
    Header header;
    const Header expected;
    std::error_code ignored;
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header) || header.magic != expected.magic ||
        header.key != key || header.file_size() != fs::file_size(path, ignored)) {
        return std::nullopt;
    }
    SceneBvhs bvhs;
    read_tree(file, header.opaque, bvhs.opaque);
    read_tree(file, header.glass, bvhs.glass);
    bvhs.has_glass = header.has_glass != 0;
    if (!file || checksum_of(header, bvhs) != header.checksum) {
        return std::nullopt;
    }
    fetch_triangles(bvhs.opaque, scene);
    fetch_triangles(bvhs.glass, scene);
    return bvhs;
}

Header::Tree describe(const Bvh& bvh) {
    return {bvh.nodes.size(), bvh.triangle_ids.size(), bvh.sah_cost, bvh.depth};
}

void write(const fs::path& path, const Key& key, const SceneBvhs& bvhs) {
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    // Renamed into place, so that another process never reads half a file.
    const fs::path temporary = path.string() + "." + std::to_string(getpid());
    std::ofstream file(temporary, std::ios::binary);
    Header header;
    header.key = key;
    header.opaque = describe(bvhs.opaque);
    header.glass = describe(bvhs.glass);
    header.has_glass = bvhs.has_glass ? 1 : 0;
    header.checksum = checksum_of(header, bvhs);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    for (const Bvh* bvh : {&bvhs.opaque, &bvhs.glass}) {
        write_array(file, bvh->nodes);
        write_array(file, bvh->triangle_ids);
    }
    file.close();
    if (!file) {
        fs::remove(temporary, ignored);
        return;
    }
    fs::rename(temporary, path, ignored);
}

/// Removes trees, those first that were not used for longest, until the rest fits.
void shrink(const fs::path& folder, std::uintmax_t most_bytes) {
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
    for (auto file = files.begin(); file != files.end() && sum > most_bytes; ++file) {
        fs::remove(file->path, ignored);
        sum -= file->bytes;
    }
}

}  // namespace

SceneBvhs find_or_build_scene_bvhs(const Scene& scene, const BvhConfig& config, const BvhCacheConfig& cache) {
    if (cache.folder.empty() || cache.folder == "none" || scene.triangles.size() < cache.least_triangles) {
        return build_scene_bvhs(scene, config);
    }
    const Key key = key_of(scene, config);
    const fs::path path = cache.folder / (hex_digits(key[0]) + kExtension);
    if (std::optional<SceneBvhs> kept = read(path, key, scene)) {
        std::error_code ignored;
        fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
        say_debug("trees taken from " + path.string());
        return std::move(*kept);
    }
    SceneBvhs bvhs = build_scene_bvhs(scene, config);
    write(path, key, bvhs);
    shrink(cache.folder, cache.most_bytes);
    return bvhs;
}

}  // namespace nearlight
