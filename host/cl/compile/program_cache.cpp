// SPDX-License-Identifier: Apache-2.0
#include "host/cl/compile/program_cache.h"

#include <unistd.h>
#include <fstream>
#include <sstream>
#include <system_error>

#include "host/base/hash.h"

namespace nearlight::core {
namespace {

/// Key length and key, then checksum, then the binary.
std::string header_of(const std::string& key, const std::string& binary) {
    return "nearlight program 1\n" + std::to_string(key.size()) + "\n" + key + "\n" +
           hex_digits(hash128(binary)) + "\n";
}

}  // namespace

ProgramCache::ProgramCache(std::filesystem::path dir) : dir_(std::move(dir)) {
    if (dir_ == "none") {
        dir_.clear();
    }
}

std::filesystem::path ProgramCache::path_of(const std::string& key) const {
    return dir_ / (hex_digits(fnv1a(key)) + ".clbin");
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
    return std::vector<unsigned char>(binary.begin(), binary.end());
}

void ProgramCache::store(const std::string& key, const std::vector<unsigned char>& binary) const {
    if (dir_.empty()) {
        return;
    }
    std::error_code ignored;
    std::filesystem::create_directories(dir_, ignored);
    // Renamed into place, so that another process never reads half a file.
    const std::filesystem::path temporary = path_of(key).string() + "." + std::to_string(getpid());
    {
        std::ofstream file(temporary, std::ios::binary);
        const std::string text(binary.begin(), binary.end());
        file << header_of(key, text) << text;
        if (!file) {
            std::filesystem::remove(temporary, ignored);
            return;
        }
    }
    std::filesystem::rename(temporary, path_of(key), ignored);
}

}  // namespace nearlight::core
