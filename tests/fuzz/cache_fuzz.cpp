// SPDX-License-Identifier: Apache-2.0
// What earlier runs left: tunables, compiled programs, trees and measured cells.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/base/files.h"
#include "host/bvh/bvh_cache.h"
#include "host/cl/compile/program_cache.h"
#include "host/cl/devices/tunables.h"
#include "host/compare/cell_store.h"
#include "nearlight/error.h"
#include "tests/fuzz/targets.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core::fuzz {
namespace {

namespace fs = std::filesystem;

/// The file that the cache makes in an empty folder.
template <typename Make>
fs::path file_made_in(const char* folder_name, const Make& make) {
    const fs::path folder = scratch_folder() / folder_name;
    fs::create_directories(folder);
    make(folder);
    return fs::directory_iterator(folder)->path();
}

/// Writes the bytes over the file's contents from a place that the first two bytes tell, so that what follows
/// them may remain as it was.
void patch(const fs::path& file, Bytes bytes) {
    if (bytes.size() < 2) {
        return;
    }
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(bytes[0] + 256 * bytes[1]);
    stream.write(reinterpret_cast<const char*>(bytes.data() + 2),
                 static_cast<std::streamsize>(bytes.size() - 2));
}

void read_program(Bytes bytes) {
    const std::string key = "kernels of a device";
    const ProgramCache cache(scratch_folder() / "programs");
    static const fs::path kFile = file_made_in("programs", [&](const fs::path&) {
        cache.store(key, {1, 2, 3});
    });
    cache.store(key, {1, 2, 3});
    patch(kFile, bytes);
    static_cast<void>(cache.find(key));
}

void read_tree(Bytes bytes) {
    static const Scene kScene = [] {
        Scene scene;
        small_scenes::add_quad(
            scene, {}, {1, 0, 0}, {0, 1, 0},
            small_scenes::add_material(scene, small_scenes::lambertian({0.5f, 0.5f, 0.5f})));
        return scene;
    }();
    const auto find = [](const fs::path& folder) {
        return find_or_build_scene_tree(kScene, {}, {}, {.folder = folder, .min_triangles = 0});
    };
    static const fs::path kFile = file_made_in("trees", find);
    patch(kFile, bytes);
    static_cast<void>(find(kFile.parent_path()));  // a damaged file is written anew
}

void read_cell(Bytes bytes) {
    const CellStore store(scratch_folder() / "cells", "conditions");
    const CellId id{.method = default_method(), .vpls = 100, .seed = 1};
    static const fs::path kFile = store.file_stem_of(id).string() + ".json";
    fs::create_directories(kFile.parent_path());
    put(kFile.lexically_relative(scratch_folder()).string(), bytes);
    static_cast<void>(store.load(id));
}

}  // namespace

void fuzz_tunables(Bytes bytes) {
    DeviceEntry entry;
    entry.name = entry.platform = entry.version = entry.driver = "x";
    // After a first byte that is odd, the bytes follow on a head that is right.
    static const std::string kHead = [&] {
        const std::vector<std::string> kernels{"film.cl"};
        store_tunables(tunables_row(DeviceKind::cpu).values, kernels, entry, scratch_folder(), {});
        const std::string text = read_bytes(tunables_file(entry, scratch_folder()));
        return text.substr(0, text.find('\n', text.find("\nkernels ") + 1) + 1);
    }();
    const bool has_head = !bytes.empty() && bytes[0] % 2 == 1;
    const std::string rest(bytes.begin() + (has_head ? 1 : 0), bytes.end());
    put(tunables_file(entry, scratch_folder()).filename().string(), (has_head ? kHead : "") + rest);
    static_cast<void>(choose_tunables(entry, scratch_folder(), {}));
}

void fuzz_cache(Bytes bytes) {
    if (bytes.empty()) {
        return;
    }
    try {
        const auto read = bytes[0] % 3 == 0 ? read_program : bytes[0] % 3 == 1 ? read_tree : read_cell;
        read(bytes.subspan(1));
    } catch (const Error&) {
        return;  // was refused
    }
}

}  // namespace nearlight::core::fuzz
