// SPDX-License-Identifier: Apache-2.0
// A glTF 2.0 file in memory, as tinygltf reads it. Only the files of this folder know tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/base/math.h"
#include "host/scene/note_sink.h"

namespace nearlight::core::gltf {

struct GltfFile {
    std::filesystem::path path;
    tinygltf::Model model;  ///< Image::image holds the encoded bytes of images from data URIs

    /// Throws Error(ErrorKind::file): "FILE: what".
    [[noreturn]] void fail(const std::string& what) const;
    /// The element that `owner` refers to, or an error that says so: tinygltf checks no references.
    template <typename T>
    const T& at(const std::vector<T>& values, int index, const char* what, const std::string& owner) const {
        if (index < 0 || static_cast<std::size_t>(index) >= values.size()) {
            fail(owner + " refers to " + what + " " + std::to_string(index) + ", but there are only " +
                 std::to_string(values.size()));
        }
        return values[static_cast<std::size_t>(index)];
    }
};

/// .gltf with its buffers, or .glb. Throws where the file is broken, or needs an extension that we do not
/// know; images are left alone.
GltfFile read_gltf(const std::filesystem::path& path);

/// A buffer view, whole. Throws where it reaches beyond its buffer.
std::span<const std::byte> bytes_of(const GltfFile& file, int buffer_view);

/// The numbers of an accessor, `components` for each element, integers of normalised accessors as fractions.
/// Sparse ones are filled in. Throws where it has another shape or reaches beyond its buffer.
std::vector<float> read_numbers(const GltfFile& file, int accessor, int components);
/// The same of one integer each.
std::vector<uint> read_indices(const GltfFile& file, int accessor);

/// A number of an extension's object, or `fallback`.
double number_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
                 double fallback);
/// The same of an index; what is none, is too large for one or below 0, is −1.
int index_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, int fallback);
/// Three numbers.
Vec3 color_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
              Vec3 fallback);

}  // namespace nearlight::core::gltf
