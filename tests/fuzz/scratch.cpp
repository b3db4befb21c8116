// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <fstream>
#include <string>
#include <system_error>

#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {
namespace {

namespace fs = std::filesystem;

class ScratchFolder {
  public:
    ScratchFolder() {
        std::error_code ignored;
        const fs::path in_memory = "/dev/shm";
        const fs::path parent = fs::is_directory(in_memory, ignored) ? in_memory : fs::temp_directory_path();
        path_ = parent / ("nearlight-fuzz-" + std::to_string(::getpid()));
        fs::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

}  // namespace

const fs::path& scratch_folder() {
    static const ScratchFolder folder;
    return folder.path();
}

fs::path put(std::string_view name, Bytes bytes) {
    const fs::path file = scratch_folder() / name;
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
}

fs::path put(std::string_view name, std::string_view text) {
    return put(name, Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace nearlight::core::fuzz
