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

    /// Throws Error(ErrorKind::file) with "FILE: what".
    [[noreturn]] void fail(const std::string& what) const;
    /// The element that `owner` refers to. Calls fail() if there is none, because tinygltf checks no
    /// references.
    template <typename T>
    const T& at(const std::vector<T>& values, int index, const char* what, const std::string& owner) const {
        if (index < 0 || static_cast<std::size_t>(index) >= values.size()) {
            fail(owner + " refers to " + what + " " + std::to_string(index) + ", but there are only " +
                 std::to_string(values.size()));
        }
        return values[static_cast<std::size_t>(index)];
    }
};

/// Reads .gltf with its buffers, or .glb, but not the images. Throws Error(ErrorKind::file) if the file is
/// broken or needs an extension that is not supported.
GltfFile read_gltf(const std::filesystem::path& path);

/// Notes the extensions that the file uses and nothing here reads, by their names. Those of materials and
/// textures are noted by whoever makes these.
void note_unread_extensions(const GltfFile& file, NoteSink& notes);

/// The name of a file that a URI stands for, with `%20` and its like decoded.
std::string decoded_uri(const std::string& uri);

/// The bytes of a buffer view. Calls fail() if it reaches beyond its buffer.
std::span<const std::byte> bytes_of(const GltfFile& file, int buffer_view);

/// The numbers of an accessor, `components` for each element. Integers of normalised accessors become
/// fractions, and sparse elements are filled in. Calls fail() if the accessor has another shape or reaches
/// beyond its buffer.
std::vector<float> read_numbers(const GltfFile& file, int accessor, int components);
/// The elements of an accessor that are one integer each. Calls fail() as read_numbers() does.
std::vector<uint> read_indices(const GltfFile& file, int accessor);

/// The number `key` of an extension's object, or `fallback` if there is none.
double number_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
                 double fallback);
/// The index `key` of an extension's object, or `fallback` if there is none; −1 if it is negative or too
/// large.
int index_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, int fallback);
/// The numbers `key` of an extension's object; empty if there are not `count` of them.
std::vector<double> numbers_of(const tinygltf::ExtensionMap& extensions, const char* extension,
                               const char* key, std::size_t count);
/// The three numbers `key` of an extension's object, or `fallback` if there are not three.
Vec3 color_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
              Vec3 fallback);
/// The texture `key` of an extension's object; its index is −1 if there is none.
tinygltf::TextureInfo texture_of(const tinygltf::ExtensionMap& extensions, const char* extension,
                                 const char* key);

}  // namespace nearlight::core::gltf
