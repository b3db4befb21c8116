// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/gltf_file.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <string_view>
#include <system_error>

#include "host/base/files.h"
#include "host/scene/file_text.h"
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

/// Fails if an extension that the file requires is not supported, or not in this build.
void check_required(const GltfFile& file, const std::string& extension) {
    const Compression* const compression = compression_of(extension);
    if (compression != nullptr && !compression->can_decode()) {
        file.fail("needs the extension " + extension + ", which this build lacks; build with " +
                  compression->library + " (Debian's " + compression->package +
                  "), or export the scene without it");
    }
    if (compression == nullptr &&
        std::ranges::find(kKnownExtensions, extension) == std::end(kKnownExtensions)) {
        file.fail("needs the extension " + extension +
                  ", which is not supported; export the scene without it");
    }
}

/// Whether a file uses a compression that this build can decode.
bool is_decoded(const JsonSurvey& survey, std::string_view extension) {
    return survey.is_valid && std::ranges::find(survey.used, extension) != survey.used.end() &&
           compression_of(extension)->can_decode();
}

bool is_decoded_by_meshopt(const JsonSurvey& survey) {
    return is_decoded(survey, "EXT_meshopt_compression") || is_decoded(survey, "KHR_meshopt_compression");
}

/// The file without what stands beside compressed meshes and what tinygltf refuses there.
std::string without_stand_ins(std::string text, const JsonSurvey& survey) {
    if (is_decoded(survey, "KHR_draco_mesh_compression")) {
        text = without_compressed_indices(text);
    }
    if (is_decoded_by_meshopt(survey)) {
        text = without_fallback_buffers(text);
    }
    return text;
}

/// The deepest nesting of JSON that is read, because tinygltf follows it on the stack.
constexpr std::size_t kMaxNesting = 200;

/// The version in the header of a .glb, or 0.
std::uint32_t container_version(std::string_view text) {
    std::uint32_t version = 0;
    if (text.starts_with("glTF") && text.size() >= 8) {
        std::memcpy(&version, text.data() + 4, sizeof version);
    }
    return version;
}

/// Refuses what tinygltf must not see: glTF 1, extensions that are not supported here, and JSON that would
/// overflow the stack.
void check_before_reading(const GltfFile& file, std::string_view text, const JsonSurvey& survey) {
    if (container_version(text) == 1 || survey.is_version_1) {
        file.fail("is of glTF 1, but only glTF 2.0 is read; convert it, for example with gltf-pipeline");
    }
    for (const std::string& extension : survey.required) {
        check_required(file, extension);
    }
    if (survey.depth > kMaxNesting) {
        file.fail("its JSON is nested " + std::to_string(survey.depth) + " levels deep, which is more than " +
                  std::to_string(kMaxNesting) + "; export the scene without 'extras'");
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
/// them; the bytes that tinygltf passes for a buffer may lie beyond its end.
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
    if (image->uri.empty() && image->bufferView < 0) {
        image->image.assign(bytes, bytes + size);
        image->as_is = true;
    }
    return true;
}

/// The names under which tinygltf looks for the files of images. A buffer may be in one of these files, too,
/// which is then not among them.
std::set<std::string> find_image_paths(const std::filesystem::path& path, const JsonSurvey& survey) {
    std::set<std::string> paths;
    const std::string folder = path.parent_path().string();
    const std::string start = folder.empty() || folder.ends_with('/') ? folder : folder + "/";
    for (const std::string& uri : survey.images) {
        paths.insert({start + decoded_uri(uri), "./" + decoded_uri(uri)});
    }
    for (const std::string& uri : survey.buffers) {
        paths.erase(start + decoded_uri(uri));
        paths.erase("./" + decoded_uri(uri));
    }
    return paths;
}

/// Hides the files of images from tinygltf, which would read all of them, only for keep_image() to drop what
/// it has read. It makes nothing of files that are missing.
bool is_no_image(const std::string& path, void* paths_of_images) {
    std::error_code ignored;
    return !static_cast<const std::set<std::string>*>(paths_of_images)->contains(path) &&
           std::filesystem::exists(path.c_str(), ignored);
}

/// Refuses pipes, for which tinygltf would wait, and folders, which it takes for files of 2⁶³ bytes. The path
/// ends where a file system ends it: at a zero byte, which a damaged URI may decode to.
bool read_plain_file(std::vector<unsigned char>* bytes, std::string* error, const std::string& path,
                     void* unused) {
    *error = reason_not_to_read(path.c_str());
    return error->empty() && tinygltf::ReadWholeFile(bytes, error, path, unused);
}

tinygltf::FsCallbacks callbacks_without(std::set<std::string>& paths_of_images) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = is_no_image;
    callbacks.ExpandFilePath = tinygltf::ExpandFilePath;
    callbacks.ReadWholeFile = read_plain_file;
    callbacks.WriteWholeFile = tinygltf::WriteWholeFile;
    callbacks.user_data = &paths_of_images;
    return callbacks;
}

/// Decodes images in data URIs of kinds that tinygltf leaves as they are, such as WebP.
void decode_other_images(tinygltf::Model& model) {
    for (tinygltf::Image& image : model.images) {
        const std::size_t comma = image.uri.find(',');
        const std::string head = image.uri.substr(0, comma);
        if (!head.starts_with("data:image/") || !head.ends_with(";base64")) {
            continue;
        }
        // tinygltf decodes bytes of this kind, whatever they are.
        const std::string known = "data:application/octet-stream;base64," + image.uri.substr(comma + 1);
        std::string kind;
        if (tinygltf::DecodeDataURI(&image.image, kind, known, 0, false)) {
            image.mimeType = head.substr(5, head.find(';') - 5);
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
    std::string text = read_file_text(path);
    const JsonSurvey survey = survey_json(json_of(text));
    check_before_reading(file, text, survey);
    text = without_stand_ins(std::move(text), survey);
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_image, nullptr);
    std::set<std::string> hidden = find_image_paths(path, survey);
    static_cast<void>(reader.SetFsCallbacks(callbacks_without(hidden)));
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
    check_version(file);
    decode_other_images(file.model);
    if (is_decoded_by_meshopt(survey)) {
        decode_meshopt(file);
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
