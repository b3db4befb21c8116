// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/buffers.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "host/scene/file_text.h"
#include "nearlight/error.h"

namespace nearlight::core::gltf {
namespace {

void check_length(const GltfFile& file, const std::string& owner, std::uint64_t needed, std::uint64_t there) {
    if (there < needed) {
        file.fail(owner + " has only " + std::to_string(there) + " bytes, but its byteLength is " +
                  std::to_string(needed) + "; it may have been cut short");
    }
}

FileParts open_buffer(const GltfFile& file, const std::string& owner, const std::string& name) {
    try {
        return FileParts(file.path.parent_path() / name);
    } catch (const Error& error) {
        file.fail(owner + " cannot be read: " + error.what());
    }
}

/// Reads no more of the file than the buffer needs, and takes no memory before the file is known to be long
/// enough.
std::vector<unsigned char> read_buffer_file(const GltfFile& file, const std::string& owner,
                                            const BufferSource& source) {
    const std::string name = decoded_uri(source.uri);
    FileParts parts = open_buffer(file, owner, name);
    check_length(file, owner + " in '" + name + "'", source.length, parts.size());
    std::vector<unsigned char> bytes(source.length);
    parts.read_into(0, {reinterpret_cast<char*>(bytes.data()), bytes.size()});
    return bytes;
}

std::vector<unsigned char> read_buffer(const GltfFile& file, const std::string& owner,
                                       const BufferSource& source, std::string_view binary) {
    if (source.is_in_file) {
        check_length(file, owner, source.length, binary.size());
        return {binary.begin(), binary.begin() + static_cast<std::ptrdiff_t>(source.length)};
    }
    if (source.uri.empty()) {
        file.fail(owner + " has no URI, and its bytes are not in the file; export the scene again");
    }
    if (!source.uri.starts_with("data:")) {
        return read_buffer_file(file, owner, source);
    }
    std::vector<unsigned char> bytes;
    if (!decode_data_uri(source.uri, bytes)) {
        file.fail(owner + " has a data URI that is not in base64");
    }
    check_length(file, owner, source.length, bytes.size());
    bytes.resize(source.length);
    return bytes;
}

}  // namespace

bool decode_data_uri(const std::string& uri, std::vector<unsigned char>& bytes) {
    constexpr std::string_view kEndOfHead = ";base64,";
    const std::size_t comma = uri.find(',');
    if (!uri.starts_with("data:") || comma == std::string::npos ||
        !std::string_view(uri).substr(0, comma + 1).ends_with(kEndOfHead)) {
        return false;
    }
    // tinygltf decodes bytes of this kind, whatever they are.
    std::string kind;
    return tinygltf::DecodeDataURI(&bytes, kind,
                                   "data:application/octet-stream;base64," + uri.substr(comma + 1), 0, false);
}

void read_buffers(GltfFile& file, std::vector<BufferSource> sources, std::string_view binary) {
    for (std::size_t i = 0; i < std::min(sources.size(), file.model.buffers.size()); ++i) {
        const BufferSource source = std::move(sources[i]);  // gone before the next one is read
        std::vector<unsigned char>& bytes = file.model.buffers[i].data;
        bytes.clear();
        if (!source.is_stand_in) {
            bytes = read_buffer(file, "buffer " + std::to_string(i), source, binary);
        }
    }
}

}  // namespace nearlight::core::gltf
