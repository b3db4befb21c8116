// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/program_cache.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "host/base/atomic_file.h"
#include "host/base/hash.h"

namespace nearlight::core {
namespace {

/// The head of a cache file: the length of the key, the key, and the checksum of the binary that follows.
std::string header_of(const std::string& key, const std::string& binary) {
    return "nearlight program 1\n" + std::to_string(key.size()) + "\n" + key + "\n" +
           hex_digits(hash128(binary)) + "\n";
}

}  // namespace

bool lacks_a_kernel(std::span<const unsigned char> binary) {
    // The machine code of a kernel is a file in PoCL's program: "/NAME/0-0-0/NAME.so", its size in 4 bytes
    // and its content.
    using namespace std::string_view_literals;
    constexpr std::string_view kEmptyFile = ".so\0\0\0\0"sv;
    const std::string_view text(reinterpret_cast<const char*>(binary.data()), binary.size());
    for (std::size_t end = text.find(kEmptyFile); end != text.npos; end = text.find(kEmptyFile, end + 1)) {
        const std::string_view before = text.substr(0, end);
        const std::string_view name = before.substr(before.rfind('/') + 1);
        const std::string folder = "/" + std::string(name) + "/";
        constexpr std::size_t kMaxSizes = 32;  // characters of the local size
        const std::size_t near = end - std::min(end, 2 * name.size() + folder.size() + kMaxSizes);
        if (!name.empty() && before.substr(near).find(folder) != before.npos) {
            return true;
        }
    }
    return false;
}

ProgramCache::ProgramCache(std::filesystem::path dir) : dir_(std::move(dir)) {
    if (dir_ == "none") {
        dir_.clear();
    }
}

std::filesystem::path ProgramCache::path_of(const std::string& key) const {
    return dir_ / (hex_digits(hash64(key)) + ".clbin");
}

std::optional<std::vector<unsigned char>> ProgramCache::find(const std::string& key) const {
    if (dir_.empty()) {
        return std::nullopt;
    }
    std::ifstream file(path_of(key), std::ios::binary);
    std::ostringstream stream;
    stream << file.rdbuf();
    const std::string text = stream.str();
    const std::size_t header_size = header_of(key, "").size();
    if (!file || text.size() <= header_size) {
        return std::nullopt;
    }
    const std::string binary = text.substr(header_size);
    if (text.compare(0, header_size, header_of(key, binary)) != 0) {
        return std::nullopt;
    }
    std::vector<unsigned char> kept(binary.begin(), binary.end());
    return lacks_a_kernel(kept) ? std::nullopt : std::optional(std::move(kept));
}

void ProgramCache::store(const std::string& key, const std::vector<unsigned char>& binary) const {
    if (dir_.empty()) {
        return;
    }
    std::error_code ignored;
    std::filesystem::create_directories(dir_, ignored);
    AtomicFile result(path_of(key));
    std::ofstream file(result.temporary(), std::ios::binary);
    const std::string text(binary.begin(), binary.end());
    file << header_of(key, text) << text;
    file.close();
    if (file) {
        ignored = result.commit(Durability::cache);
    }
}

}  // namespace nearlight::core
