// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/json_survey.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

namespace nearlight::core::gltf {
namespace {

using Json = nlohmann::json;

/// Follows the nesting, and collects the strings of the root's lists of extensions, and the names of files
/// that stand in its lists of images and buffers.
class Surveyor : public nlohmann::json_sax<Json> {
  public:
    explicit Surveyor(JsonSurvey& survey) : survey_(survey) {}

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool string(string_t& value) override {
        if (list_ != nullptr && depth_ == 2) {
            list_->push_back(value);
        }
        if (files_ != nullptr && depth_ == 3 && is_uri_ && !value.starts_with("data:")) {
            files_->push_back(value);
        }
        return true;
    }
    bool key(string_t& value) override {
        if (depth_ == 1) {
            list_ = value == "extensionsRequired" ? &survey_.required
                    : value == "extensionsUsed"   ? &survey_.used
                                                  : nullptr;
            files_ = value == "images" ? &survey_.images : value == "buffers" ? &survey_.buffers : nullptr;
            is_list_ = value == "meshes" || value == "nodes" || value == "scenes";
        }
        is_uri_ = value == "uri";
        return true;
    }
    bool start_object(std::size_t) override {
        survey_.is_version_1 |= is_list_ && depth_ == 1;
        return begin();
    }
    bool start_array(std::size_t) override { return begin(); }
    bool end_object() override { return end(); }
    bool end_array() override { return end(); }
    bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }

  private:
    bool begin() {
        survey_.depth = std::max(survey_.depth, ++depth_);
        return true;
    }
    bool end() {
        --depth_;
        return true;
    }

    JsonSurvey& survey_;
    std::size_t depth_ = 0;
    std::vector<std::string>* list_ = nullptr;
    std::vector<std::string>* files_ = nullptr;
    bool is_uri_ = false;   ///< the latest key is that of a URI
    bool is_list_ = false;  ///< the latest key of the root names an array of glTF 2.0
};

std::string word(std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    return {reinterpret_cast<const char*>(&number), sizeof number};
}

/// The bytes of a .glb before its JSON: the headers of the file and of its first chunk.
constexpr std::size_t kBinaryHeader = 20;

/// The file with another JSON.
std::string with_json(std::string_view file, std::string json) {
    if (!file.starts_with("glTF")) {
        return json;
    }
    const std::string_view rest = file.substr(kBinaryHeader + json_of(file).size());
    json.resize((json.size() + 3) / 4 * 4, ' ');
    return std::string(file.substr(0, 8)) + word(kBinaryHeader + json.size() + rest.size()) +
           word(json.size()) + std::string(file.substr(16, 4)) + json + std::string(rest);
}

/// The objects of an array of an object; none if there is no such array.
std::vector<Json*> objects_of(Json& object, const char* key) {
    std::vector<Json*> objects;
    if (object.is_object() && object.contains(key) && object[key].is_array()) {
        for (Json& element : object[key]) {
            if (element.is_object()) {
                objects.push_back(&element);
            }
        }
    }
    return objects;
}

bool has_extension(const Json& object, const char* extension) {
    return object.contains("extensions") && object["extensions"].is_object() &&
           object["extensions"].contains(extension);
}

/// Whether a buffer is marked as standing in for what the extension holds.
bool is_fallback_of(const Json& buffer, const char* extension) {
    if (!has_extension(buffer, extension)) {
        return false;
    }
    const Json& object = buffer["extensions"][extension];
    return object.is_object() && object.value("fallback", Json(false)) == Json(true);
}

/// Whether a buffer only stands in for what is compressed elsewhere. One without bytes does so, marked or
/// not; the bytes of the first one of a .glb are in the file itself.
bool is_stand_in(const Json& buffer, bool is_in_file) {
    return is_fallback_of(buffer, "EXT_meshopt_compression") ||
           is_fallback_of(buffer, "KHR_meshopt_compression") || (!buffer.contains("uri") && !is_in_file);
}

/// The file after `change` has been made to the root of its JSON.
template <typename Change>
std::string changed_json(std::string_view file, const Change& change) {
    Json root = Json::parse(json_of(file));
    change(root);
    return with_json(file, root.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

JsonSurvey survey_json(std::string_view text) {
    JsonSurvey survey;
    Surveyor surveyor(survey);
    survey.is_valid = Json::sax_parse(text, &surveyor);
    return survey;
}

std::string_view json_of(std::string_view file) {
    if (!file.starts_with("glTF")) {
        return file;
    }
    if (file.size() < kBinaryHeader) {
        return {};
    }
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + 12, sizeof length);
    return file.substr(kBinaryHeader, length);
}

std::string without_compressed_indices(std::string_view file) {
    return changed_json(file, [](Json& root) {
        for (Json* const mesh : objects_of(root, "meshes")) {
            for (Json* const primitive : objects_of(*mesh, "primitives")) {
                if (has_extension(*primitive, "KHR_draco_mesh_compression")) {
                    primitive->erase("indices");
                }
            }
        }
    });
}

std::string without_fallback_buffers(std::string_view file) {
    return changed_json(file, [&](Json& root) {
        bool is_in_file = file.starts_with("glTF");
        for (Json* const buffer : objects_of(root, "buffers")) {
            if (is_stand_in(*buffer, is_in_file)) {
                (*buffer)["byteLength"] = 1;
                (*buffer)["uri"] = "data:application/octet-stream;base64,AA==";
            }
            is_in_file = false;
        }
    });
}

}  // namespace nearlight::core::gltf
