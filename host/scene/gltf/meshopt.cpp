// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/meshopt.h"

#if NEARLIGHT_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace nearlight::core::gltf {

#if NEARLIGHT_HAS_MESHOPTIMIZER
namespace {

/// What the extension's object says of a view.
struct CompressedView {
    std::span<const unsigned char> bytes;
    std::size_t count = 0;   ///< elements
    std::size_t stride = 0;  ///< bytes of an element
    std::string mode;
    std::string filter;
};

constexpr std::size_t kMaxStride = 256;
/// Decoded bytes for a compressed one, at most: a block of 256 bytes takes no less than two bits. Views that
/// promise more, each by itself or all together from the same bytes, are refused before memory is taken.
constexpr std::size_t kMaxRatio = 1024;

const char* extension_of(const tinygltf::BufferView& view) {
    for (const char* const name : {"KHR_meshopt_compression", "EXT_meshopt_compression"}) {
        if (view.extensions.contains(name)) {
            return name;
        }
    }
    return nullptr;
}

std::string text_of(const tinygltf::Value& object, const char* key, const char* fallback) {
    return object.Has(key) && object.Get(key).IsString() ? object.Get(key).Get<std::string>() : fallback;
}

std::size_t size_of(const GltfFile& file, const tinygltf::ExtensionMap& extensions, const char* extension,
                    const char* key, const std::string& owner) {
    const int value = index_of(extensions, extension, key, 0);
    if (value < 0) {
        file.fail(owner + ": " + key + " is not a whole number");
    }
    return static_cast<std::size_t>(value);
}

CompressedView compressed_view(const GltfFile& file, const tinygltf::BufferView& view, const char* extension,
                               const std::string& owner) {
    const tinygltf::ExtensionMap& extensions = view.extensions;
    const tinygltf::Buffer& buffer =
        file.at(file.model.buffers, index_of(extensions, extension, "buffer", -1), "buffer", owner);
    const std::size_t offset = size_of(file, extensions, extension, "byteOffset", owner);
    const std::size_t length = size_of(file, extensions, extension, "byteLength", owner);
    if (offset > buffer.data.size() || length > buffer.data.size() - offset) {
        file.fail(owner + " reaches beyond the end of its compressed buffer");
    }
    const tinygltf::Value& object = extensions.at(extension);
    CompressedView compressed{std::span(buffer.data).subspan(offset, length),
                              size_of(file, extensions, extension, "count", owner),
                              size_of(file, extensions, extension, "byteStride", owner),
                              text_of(object, "mode", ""), text_of(object, "filter", "NONE")};
    if (compressed.stride == 0 || compressed.stride > kMaxStride ||
        compressed.count > kMaxRatio * length / compressed.stride) {
        file.fail(owner + " has a stride of " + std::to_string(compressed.stride) + " and " +
                  std::to_string(compressed.count) + " elements in " + std::to_string(length) +
                  " compressed bytes, which is impossible");
    }
    return compressed;
}

/// Whether the elements have a size that the mode and the filter are made for; the library takes it for
/// granted.
bool has_right_stride(const CompressedView& view) {
    if (view.mode != "ATTRIBUTES") {
        return (view.stride == 2 || view.stride == 4) && (view.mode != "TRIANGLES" || view.count % 3 == 0);
    }
    return view.filter == "OCTAHEDRAL"   ? view.stride == 4 || view.stride == 8
           : view.filter == "QUATERNION" ? view.stride == 8
                                         : view.stride % 4 == 0;
}

/// Returns false if the bytes are broken or of a later version than the library's.
bool decode(const CompressedView& view, unsigned char* to) {
    using Decoder = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
    Decoder decoder = meshopt_decodeVertexBuffer;
    if (view.mode == "TRIANGLES") {
        decoder = meshopt_decodeIndexBuffer;
    } else if (view.mode == "INDICES") {
        decoder = meshopt_decodeIndexSequence;
    }
    return decoder(to, view.count, view.stride, view.bytes.data(), view.bytes.size()) == 0;
}

void apply_filter(const CompressedView& view, unsigned char* elements) {
    if (view.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(elements, view.count, view.stride);
    } else if (view.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(elements, view.count, view.stride);
    } else if (view.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(elements, view.count, view.stride);
    }
}

tinygltf::Buffer decoded_buffer(const GltfFile& file, const CompressedView& view, const std::string& owner) {
    const bool is_known_mode =
        view.mode == "ATTRIBUTES" || view.mode == "TRIANGLES" || view.mode == "INDICES";
    const bool is_known_filter = view.filter == "NONE" || view.filter == "OCTAHEDRAL" ||
                                 view.filter == "QUATERNION" || view.filter == "EXPONENTIAL";
    if (!is_known_mode || !is_known_filter) {
        file.fail(owner + " is compressed with mode '" + view.mode + "' and filter '" + view.filter +
                  "', which are not supported; export the scene without compression");
    }
    if (!has_right_stride(view)) {
        file.fail(owner + " has " + std::to_string(view.count) + " elements of " +
                  std::to_string(view.stride) + " bytes, which mode " + view.mode + " and filter " +
                  view.filter + " cannot have");
    }
    tinygltf::Buffer buffer;
    buffer.data.resize(view.count * view.stride);
    if (!decode(view, buffer.data.data())) {
        file.fail(owner +
                  " cannot be decoded: its compressed bytes are broken, or of a later version of "
                  "meshoptimizer than this build's");
    }
    apply_filter(view, buffer.data.data());
    return buffer;
}

}  // namespace

bool can_decode_meshopt() {
    return true;
}

void decode_meshopt(GltfFile& file) {
    std::size_t room = 0;  // for decoded bytes
    for (const tinygltf::Buffer& buffer : file.model.buffers) {
        room += kMaxRatio * buffer.data.size();
    }
    for (std::size_t i = 0; i < file.model.bufferViews.size(); ++i) {
        tinygltf::BufferView& view = file.model.bufferViews[i];
        const char* const extension = extension_of(view);
        if (extension == nullptr) {
            continue;
        }
        const std::string owner = "buffer view " + std::to_string(i);
        const CompressedView compressed = compressed_view(file, view, extension, owner);
        if (compressed.count * compressed.stride > room) {
            file.fail(owner +
                      " is one of so many of the same compressed bytes that they would take more than " +
                      std::to_string(kMaxRatio) + " times the size of the file");
        }
        room -= compressed.count * compressed.stride;
        tinygltf::Buffer buffer = decoded_buffer(file, compressed, owner);
        view.buffer = static_cast<int>(file.model.buffers.size());
        view.byteOffset = 0;
        view.byteLength = buffer.data.size();
        file.model.buffers.push_back(std::move(buffer));
    }
}

#else

bool can_decode_meshopt() {
    return false;
}

void decode_meshopt(GltfFile& file) {
    file.fail("is compressed by meshoptimizer, which this build lacks");
}

#endif

}  // namespace nearlight::core::gltf
