// SPDX-License-Identifier: Apache-2.0
// The error for broken image files, which both the library and its module throw.
#include <algorithm>

#include "host/image/image_codec.h"
#include "nearlight/error.h"

namespace nearlight::core {

void fail_image(const char* what, const std::filesystem::path& file, std::string reason) {
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    reason.erase(reason.find_last_not_of(" .") + 1);
    throw Error(ErrorKind::file, std::string(what) + " '" + file.string() +
                                     "': " + (reason.empty() ? "unknown reason" : reason));
}

void check_fits_in_file(const std::filesystem::path& file, std::uintmax_t image_bytes,
                        std::uintmax_t file_size, std::uintmax_t densest) {
    constexpr std::uintmax_t kAlwaysFine = 256u << 20u;  // 8192 × 8192 pixels of four bytes
    if (image_bytes > kAlwaysFine + densest * file_size) {
        fail_image("cannot read image", file,
                   "its header promises more pixels than a file of its size should hold");
    }
}

}  // namespace nearlight::core
