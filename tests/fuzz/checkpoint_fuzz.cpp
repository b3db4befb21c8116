// SPDX-License-Identifier: Apache-2.0
// The sums of long renders.
#include <array>
#include <span>
#include <string>

#include "host/base/hash.h"
#include "host/cli/checkpoint_file.h"
#include "nearlight/error.h"
#include "tests/fuzz/targets.h"

namespace nearlight::core::fuzz {

namespace {

/// A whole file with this header and the sums of a black picture of one pixel.
std::string with_black_pixel(const std::string& header) {
    std::string file(kCheckpointMagic);
    const auto add = [&file](std::span<const std::byte> bytes) {
        file.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    const std::array<std::uint64_t, 1> length{header.size()};
    const PassSums sums(1, 1);
    add(std::as_bytes(std::span(length)));
    file += header;
    add(std::as_bytes(sums.sums()));
    add(std::as_bytes(sums.firsts()));
    const Hash128 checksum = hash128(std::as_bytes(std::span(file)));
    add(std::as_bytes(std::span(checksum)));
    return file;
}

}  // namespace

void fuzz_checkpoint(Bytes bytes) {
    if (bytes.empty()) {
        return;
    }
    const bool is_raw = bytes[0] % 2 == 1;
    const std::string rest(bytes.begin() + 1, bytes.end());
    try {
        const CheckpointReader reader(put("checkpoint", is_raw ? rest : with_black_pixel(rest)));
        static_cast<void>(reader.read_sums());
    } catch (const Error&) {
        return;  // was refused
    }
}

}  // namespace nearlight::core::fuzz
