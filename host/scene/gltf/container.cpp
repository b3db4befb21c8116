// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/container.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>

namespace nearlight::core::gltf {
namespace {

/// Magic number, version and length.
constexpr std::size_t kContainerHeader = 12;
/// Length and type.
constexpr std::size_t kChunkHeader = 8;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
constexpr std::uint32_t kBinaryChunk = 0x004e4942;

/// The little-endian number at a place that lies within the bytes.
std::uint32_t word_at(std::string_view bytes, std::size_t place) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + place, sizeof word);
    return word;
}

struct Chunk {
    std::uint32_t type = 0;
    std::string_view bytes;
};

/// Takes the first chunk off the bytes; none if too few for a chunk are left.
std::optional<Chunk> take_chunk(const GltfFile& file, std::string_view& bytes) {
    if (bytes.size() < kChunkHeader) {
        return std::nullopt;
    }
    const std::size_t length = word_at(bytes, 0);
    const Chunk chunk{word_at(bytes, 4), bytes.substr(kChunkHeader, length)};
    if (chunk.bytes.size() < length) {
        file.fail("not a valid glTF file: a chunk of " + std::to_string(length) + " bytes ends after " +
                  std::to_string(chunk.bytes.size()) + " with the file; it may have been cut short");
    }
    bytes.remove_prefix(kChunkHeader + length);
    return chunk;
}

}  // namespace

FileChunks chunks_of(const GltfFile& file, std::string_view bytes) {
    if (!bytes.starts_with("glTF")) {
        return {.json = bytes};
    }
    if (bytes.size() >= kContainerHeader && word_at(bytes, 4) == 1) {
        return {.is_binary = true, .is_version_1 = true};
    }
    if (bytes.size() < kContainerHeader || word_at(bytes, 8) > bytes.size()) {
        file.fail("not a valid glTF file: it is shorter than its header says; it may have been cut short");
    }
    const std::size_t length = std::max<std::size_t>(word_at(bytes, 8), kContainerHeader);
    bytes = bytes.substr(kContainerHeader, length - kContainerHeader);
    std::optional<Chunk> chunk = take_chunk(file, bytes);
    if (!chunk || chunk->type != kJsonChunk) {
        file.fail("not a valid glTF file: its first chunk is not JSON");
    }
    FileChunks chunks{.json = chunk->bytes, .is_binary = true};
    // What follows the binary chunk is of unknown types, and is left alone.
    while (chunks.binary.empty() && (chunk = take_chunk(file, bytes))) {
        if (chunk->type == kBinaryChunk) {
            chunks.binary = chunk->bytes;
        }
    }
    return chunks;
}

}  // namespace nearlight::core::gltf
