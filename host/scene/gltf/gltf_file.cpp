// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "host/scene/file_text.h"
#include "nearlight/error.h"

namespace nearlight::core::gltf {
namespace {

/// The extensions that a file may require: they are read here, or can be ignored with a note.
constexpr std::array<std::string_view, 12> kKnownExtensions{
    "KHR_lights_punctual",        "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_sheen",     "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_unlit",     "KHR_materials_variants",
    "KHR_materials_volume",       "KHR_mesh_quantization",   "KHR_texture_transform"};

std::string first_line(const std::string& text) {
    return text.substr(0, text.find_first_of("\r\n"));
}

/// Keeps images from data URIs as they are. Images in files and buffers are read when a material asks for
/// them; the bytes that tinygltf passes for a buffer may lie beyond its end.
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
    if (image->uri.empty() && image->bufferView < 0) {
        image->image.assign(bytes, bytes + size);
        image->as_is = true;
    }
    return true;
}

const tinygltf::Value* member(const tinygltf::ExtensionMap& extensions, const char* extension,
                              const char* key) {
    const auto found = extensions.find(extension);
    return found != extensions.end() && found->second.Has(key) ? &found->second.Get(key) : nullptr;
}

}  // namespace

void GltfFile::fail(const std::string& what) const {
    throw Error(ErrorKind::file, path.string() + ": " + what);
}

GltfFile read_gltf(const std::filesystem::path& path) {
    GltfFile file{path, {}};
    const std::string text = read_file_text(path);
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_image, nullptr);
    std::string error;
    std::string warning;
    const std::string folder = path.parent_path().string();
    const auto size = static_cast<unsigned int>(text.size());
    const bool read =
        text.starts_with("glTF")
            ? reader.LoadBinaryFromMemory(&file.model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(text.data()), size, folder)
            : reader.LoadASCIIFromString(&file.model, &error, &warning, text.data(), size, folder);
    if (!read) {
        file.fail("not a valid glTF file: " + (error.empty() ? "it is empty" : first_line(error)));
    }
    for (const std::string& extension : file.model.extensionsRequired) {
        if (std::ranges::find(kKnownExtensions, extension) == kKnownExtensions.end()) {
            file.fail("needs the extension " + extension +
                      ", which is not supported; export the scene without it");
        }
    }
    return file;
}

double number_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
                 double fallback) {
    const tinygltf::Value* const value = member(extensions, extension, key);
    return value != nullptr && value->IsNumber() ? value->GetNumberAsDouble() : fallback;
}

int index_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, int fallback) {
    const double index = number_of(extensions, extension, key, fallback);
    return index >= 0 && index <= std::numeric_limits<int>::max() ? static_cast<int>(index) : -1;
}

Vec3 color_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
              Vec3 fallback) {
    const tinygltf::Value* const value = member(extensions, extension, key);
    if (value == nullptr || !value->IsArray() || value->ArrayLen() != 3) {
        return fallback;
    }
    const auto channel = [&](int i) { return static_cast<float>(value->Get(i).GetNumberAsDouble()); };
    return {channel(0), channel(1), channel(2)};
}

}  // namespace nearlight::core::gltf
