// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_file.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "host/scene/file_text.h"
#include "host/scene/gltf/buffers.h"
#include "host/scene/gltf/container.h"
#include "host/scene/gltf/draco_codec.h"
#include "host/scene/gltf/json_survey.h"
#include "host/scene/gltf/meshopt.h"
#include "nearlight/error.h"

namespace nearlight::core::gltf {
namespace {

/// The extensions that a file may require: they are read here, or can be ignored, with a note where that
/// changes the picture.
constexpr std::string_view kKnownExtensions[] = {
    "EXT_mesh_features",
    "EXT_mesh_gpu_instancing",
    "EXT_structural_metadata",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
};

/// Formats of images. One that is not read is noted where a material shows it and no other image is beside
/// it.
constexpr std::string_view kImageFormats[] = {
    "EXT_texture_avif",
    "GOOGLE_texture_basis",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
};

/// Extensions that say nothing of the picture, beside those of kKnownExtensions.
constexpr std::string_view kOutOfSight[] = {
    "AGI_articulations",
    "AGI_stk_metadata",
    "EXT_instance_features",
    "EXT_mesh_manifold",
    "FB_geometry_metadata",
    "KHR_audio_emitter",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_xmp",
    "MSFT_audio_emitter",
    "MSFT_lod",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
};

/// Compressions, each of which takes a library that a build may lack.
struct Compression {
    std::string_view extension;
    bool (*can_decode)();
    const char* library;
    const char* package;
};
constexpr Compression kCompressions[] = {
    {"KHR_draco_mesh_compression", can_decode_draco, "Draco", "libdraco-dev"},
    {"EXT_meshopt_compression", can_decode_meshopt, "meshoptimizer", "libmeshoptimizer-dev"},
    {"KHR_meshopt_compression", can_decode_meshopt, "meshoptimizer", "libmeshoptimizer-dev"},
};

const Compression* compression_of(std::string_view extension) {
    const auto* const found = std::ranges::find(kCompressions, extension, &Compression::extension);
    return found == std::end(kCompressions) ? nullptr : found;
}

template <std::size_t Count>
bool lists(const std::string_view (&names)[Count], std::string_view extension) {
    return std::ranges::find(names, extension) != std::end(names);
}

/// Fails if an extension that the file requires is not supported, or not in this build.
void check_required(const GltfFile& file, const std::string& extension) {
    const Compression* const compression = compression_of(extension);
    if (compression != nullptr && !compression->can_decode()) {
        file.fail("needs the extension " + extension + ", which this build lacks; build with " +
                  compression->library + " (Debian's " + compression->package +
                  "), or export the scene without it");
    }
    if (compression == nullptr && !lists(kKnownExtensions, extension)) {
        file.fail("needs the extension " + extension +
                  ", which is not supported; export the scene without it");
    }
}

/// Whether a file uses a compression that this build can decode.
bool is_decoded(const JsonSurvey& survey, std::string_view extension) {
    return std::ranges::find(survey.used, extension) != survey.used.end() &&
           compression_of(extension)->can_decode();
}

bool is_decoded_by_meshopt(const JsonSurvey& survey) {
    return is_decoded(survey, "EXT_meshopt_compression") || is_decoded(survey, "KHR_meshopt_compression");
}

/// The deepest nesting of JSON that is read, because tinygltf follows it on the stack.
constexpr std::size_t kMaxNesting = 200;

/// Refuses what tinygltf must not see: glTF 1, extensions that are not supported here, JSON that would
/// overflow the stack, and broken JSON, of which it says little that helps.
void check_before_reading(const GltfFile& file, const FileChunks& chunks, const JsonSurvey& survey) {
    if (chunks.is_version_1 || survey.is_version_1) {
        file.fail("is of glTF 1, but only glTF 2.0 is read; convert it, for example with gltf-pipeline");
    }
    for (const std::string& extension : survey.required) {
        check_required(file, extension);
    }
    if (survey.depth > kMaxNesting) {
        file.fail("its JSON is nested " + std::to_string(survey.depth) + " levels deep, which is more than " +
                  std::to_string(kMaxNesting) + "; export the scene without 'extras'");
    }
    if (!survey.fault.empty()) {
        file.fail("not a valid glTF file: its JSON is broken at " + survey.fault +
                  "; export the scene again, or correct it there");
    }
}

/// Refuses a file that asks for a later version, or is of another major one.
void check_version(const GltfFile& file) {
    const tinygltf::Asset& asset = file.model.asset;
    const std::string& needed = asset.minVersion.empty() ? asset.version : asset.minVersion;
    const bool is_read = asset.minVersion.empty() ? needed.starts_with("2.") : needed == "2.0";
    if (!is_read) {
        file.fail("needs glTF " + needed + ", but only glTF 2.0 is read");
    }
}

std::string first_line(const std::string& text) {
    return text.substr(0, text.find_first_of("\r\n"));
}

/// Keeps images from data URIs as they are. Images in files and buffers are read when a material asks for
/// them.
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
    image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

/// Hides all files from tinygltf, which would read those of images, only to drop what it has read, and would
/// wait for pipes. It makes nothing of images that are missing.
bool has_no_file(const std::string&, void*) {
    return false;
}

tinygltf::FsCallbacks callbacks_without_files() {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = has_no_file;
    callbacks.ExpandFilePath = tinygltf::ExpandFilePath;
    callbacks.ReadWholeFile = tinygltf::ReadWholeFile;
    callbacks.WriteWholeFile = tinygltf::WriteWholeFile;
    return callbacks;
}

void parse_json(GltfFile& file, const std::string& json) {
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_image, nullptr);
    static_cast<void>(reader.SetFsCallbacks(callbacks_without_files()));
    std::string error;
    std::string warning;
    if (!reader.LoadASCIIFromString(&file.model, &error, &warning, json.data(),
                                    static_cast<unsigned int>(json.size()), "")) {
        // Of a text without members, tinygltf says that it is short.
        const bool is_empty = json.size() < 4 || error.empty();
        file.fail("not a valid glTF file: " + (is_empty ? "it is empty" : first_line(error)));
    }
}

/// Gives images the buffer views that tinygltf has not seen.
void put_images_back(GltfFile& file, const std::vector<EmbeddedImage>& embedded) {
    for (const auto& [index, view] : embedded) {
        tinygltf::Image& image = file.model.images.at(index);
        const std::string owner = "image " + std::to_string(index);
        static_cast<void>(file.at(file.model.bufferViews, view, "buffer view", owner));
        image.uri.clear();
        image.bufferView = view;
    }
}

void put_indices_back(GltfFile& file, const std::vector<TakenIndices>& taken) {
    for (const auto& [mesh, primitive, accessor] : taken) {
        file.model.meshes.at(mesh).primitives.at(primitive).indices = accessor;
    }
}

/// Decodes images in data URIs of kinds that tinygltf leaves as they are, such as WebP.
void decode_other_images(tinygltf::Model& model) {
    for (tinygltf::Image& image : model.images) {
        if (image.uri.starts_with("data:image/") && decode_data_uri(image.uri, image.image)) {
            image.mimeType = image.uri.substr(5, image.uri.find(';') - 5);
            image.uri.clear();
        }
    }
}

const tinygltf::Value* member(const tinygltf::ExtensionMap& extensions, const char* extension,
                              const char* key) {
    const auto found = extensions.find(extension);
    return found != extensions.end() && found->second.Has(key) ? &found->second.Get(key) : nullptr;
}

}  // namespace

std::string decoded_uri(const std::string& uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
            name += static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2]));
            i += 2;
        } else {
            name += uri[i];
        }
    }
    return name;
}

void GltfFile::fail(const std::string& what) const {
    throw Error(ErrorKind::file, path.string() + ": " + what);
}

GltfFile read_gltf(const std::filesystem::path& path) {
    GltfFile file{path, {}};
    std::string bytes = read_file_text(path);
    const FileChunks chunks = chunks_of(file, bytes);
    const JsonSurvey survey = survey_json(chunks.json);
    check_before_reading(file, chunks, survey);
    const bool is_compressed = is_decoded_by_meshopt(survey);
    const Decoders decoders{.draco = is_decoded(survey, "KHR_draco_mesh_compression"),
                            .meshopt = is_compressed};
    LeanJson lean = lean_json(chunks.json, chunks.is_binary, decoders);
    parse_json(file, lean.text);
    check_version(file);
    put_images_back(file, lean.images);
    put_indices_back(file, lean.indices);
    if (!chunks.is_binary) {
        bytes = {};  // the data URIs in it have been taken out
    }
    read_buffers(file, std::move(lean.buffers), chunks.binary);
    decode_other_images(file.model);
    if (is_compressed) {
        decode_meshopt(file);
    }
    return file;
}

void note_unread_extensions(const GltfFile& file, NoteSink& notes) {
    const auto note = [&](const std::string& name) {
        const bool is_read = lists(kKnownExtensions, name) || compression_of(name) != nullptr;
        const bool is_noted_in_use =
            lists(kImageFormats, name) || name.find("_materials_") != std::string::npos;
        if (!is_read && !is_noted_in_use && !lists(kOutOfSight, name)) {
            notes.approximation(file.path, 0, name + " is left out");
        }
    };
    std::ranges::for_each(file.model.extensionsUsed, note);
    for (const auto& [name, value] : file.model.extensions) {
        note(name);
    }
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

std::vector<double> numbers_of(const tinygltf::ExtensionMap& extensions, const char* extension,
                               const char* key, std::size_t count) {
    const tinygltf::Value* const value = member(extensions, extension, key);
    if (value == nullptr || !value->IsArray() || value->ArrayLen() != count) {
        return {};
    }
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i) {
        const tinygltf::Value& number = value->Get(static_cast<int>(i));
        if (!number.IsNumber()) {
            return {};
        }
        numbers.push_back(number.GetNumberAsDouble());
    }
    return numbers;
}

Vec3 color_of(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key,
              Vec3 fallback) {
    const std::vector<double> numbers = numbers_of(extensions, extension, key, 3);
    return numbers.empty() ? fallback
                           : Vec3{static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
                                  static_cast<float>(numbers[2])};
}

tinygltf::TextureInfo texture_of(const tinygltf::ExtensionMap& extensions, const char* extension,
                                 const char* key) {
    tinygltf::TextureInfo info;
    const tinygltf::Value* const value = member(extensions, extension, key);
    if (value == nullptr || !value->IsObject()) {
        return info;
    }
    const tinygltf::ExtensionMap members{{"", *value}};
    info.index = index_of(members, "", "index", -1);
    info.texCoord = index_of(members, "", "texCoord", 0);
    if (value->Has("extensions") && value->Get("extensions").IsObject()) {
        for (const std::string& name : value->Get("extensions").Keys()) {
            if (const tinygltf::Value& nested = value->Get("extensions").Get(name); nested.IsObject()) {
                info.extensions[name] = nested;
            }
        }
    }
    return info;
}

}  // namespace nearlight::core::gltf
