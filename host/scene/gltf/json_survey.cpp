// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/json_survey.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace nearlight::core::gltf {
namespace {

using Json = nlohmann::json;

constexpr int kNumberOverflow = 406;  // as nlohmann's exceptions are numbered

/// Line and column of a byte of the text, counted from 1, columns in characters of UTF-8.
std::string place_of(std::string_view text, std::size_t at) {
    const std::string_view before = text.substr(0, at);
    const std::size_t line_begin = before.find_last_of('\n') + 1;  // npos + 1 is 0
    const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; };
    return "line " + std::to_string(1 + std::ranges::count(before, '\n')) + ", column " +
           std::to_string(1 + std::ranges::count_if(before.substr(line_begin), begins_character));
}

/// What is wrong with the byte `at`, which is the last one that was read. The library's own words are for
/// programmers.
std::string reason_of(std::string_view text, std::size_t at, const Json::exception& exception) {
    if (at >= text.size()) {
        return "it ends too early, and may have been cut short";
    }
    if (exception.id == kNumberOverflow) {
        return "a number is too large";
    }
    const auto byte = static_cast<unsigned char>(text[at]);
    const bool is_control = byte < 0x20;
    if (std::string_view(exception.what()).find("invalid string") != std::string_view::npos) {
        return is_control     ? "a text has a line break or another control character"
               : byte >= 0x80 ? "a text is not UTF-8"
                              : "a text is broken";
    }
    return is_control || byte >= 0x7f ? "an unexpected character"
                                      : "unexpected '" + std::string(1, text[at]) + "'";
}

/// Follows the nesting, and collects the strings of the root's lists of extensions.
class Surveyor : public nlohmann::json_sax<Json> {
  public:
    Surveyor(std::string_view text, JsonSurvey& survey) : text_(text), survey_(survey) {}

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
        return true;
    }
    bool key(string_t& value) override {
        if (depth_ == 1) {
            list_ = value == "extensionsRequired" ? &survey_.required
                    : value == "extensionsUsed"   ? &survey_.used
                                                  : nullptr;
            is_list_ = value == "meshes" || value == "nodes" || value == "scenes";
        }
        return true;
    }
    bool start_object(std::size_t) override {
        survey_.is_version_1 |= is_list_ && depth_ == 1;
        return begin();
    }
    bool start_array(std::size_t) override { return begin(); }
    bool end_object() override { return end(); }
    bool end_array() override { return end(); }
    /// `read` bytes of the text were read, or all of them and its end.
    bool parse_error(std::size_t read, const std::string&, const Json::exception& exception) override {
        const std::size_t at = std::min(read - std::min<std::size_t>(read, 1), text_.size());
        survey_.fault = place_of(text_, at) + ": " + reason_of(text_, at, exception);
        return false;
    }

  private:
    bool begin() {
        survey_.depth = std::max(survey_.depth, ++depth_);
        return true;
    }
    bool end() {
        --depth_;
        return true;
    }

    std::string_view text_;
    JsonSurvey& survey_;
    std::size_t depth_ = 0;
    std::vector<std::string>* list_ = nullptr;
    bool is_list_ = false;  ///< the latest key of the root names an array of glTF 2.0
};

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

constexpr const char* kOneByte = "data:application/octet-stream;base64,AA==";

/// Takes the source of a buffer out. One without a proper length is left, which tinygltf refuses.
BufferSource take_buffer(Json& buffer, bool is_first_of_binary, Decoders decoders) {
    BufferSource source;
    const bool has_uri = buffer.contains("uri");
    source.is_in_file = is_first_of_binary && !has_uri;
    source.is_stand_in = decoders.meshopt && is_stand_in(buffer, source.is_in_file);
    if (has_uri && buffer["uri"].is_string()) {
        source.uri = std::move(buffer["uri"].get_ref<std::string&>());
    }
    if (buffer.contains("byteLength") && buffer["byteLength"].is_number_unsigned()) {
        source.length = buffer["byteLength"].get<std::uint64_t>();
        buffer["byteLength"] = 1;
    } else if (source.is_stand_in) {
        buffer["byteLength"] = 1;
    }
    buffer["uri"] = kOneByte;
    return source;
}

/// Takes the buffer views of images out. Those that are no whole numbers are left, and those of images that
/// have a URI, too; tinygltf refuses both.
std::vector<EmbeddedImage> take_embedded_images(Json& root) {
    std::vector<EmbeddedImage> embedded;
    std::size_t index = 0;
    for (Json* const image : objects_of(root, "images")) {
        if (!image->contains("uri") && image->contains("bufferView") &&
            (*image)["bufferView"].is_number_integer()) {
            const auto view = (*image)["bufferView"].get<std::int64_t>();
            const bool is_possible = view >= 0 && view <= std::numeric_limits<int>::max();
            embedded.push_back({index, is_possible ? static_cast<int>(view) : -1});
            image->erase("bufferView");
            (*image)["uri"] = "-";
        }
        ++index;
    }
    return embedded;
}

void drop_compressed_indices(Json& root) {
    for (Json* const mesh : objects_of(root, "meshes")) {
        for (Json* const primitive : objects_of(*mesh, "primitives")) {
            if (has_extension(*primitive, "KHR_draco_mesh_compression")) {
                primitive->erase("indices");
            }
        }
    }
}

/// Whether tinygltf keeps a primitive in its model. It leaves out those whose attributes are missing or no
/// whole numbers, so that later ones move up.
bool is_kept(const Json& primitive) {
    return primitive.contains("attributes") && primitive["attributes"].is_object() &&
           std::ranges::all_of(primitive["attributes"],
                               [](const Json& accessor) { return accessor.is_number_integer(); });
}

/// Takes out indices whose accessor has no buffer view.
std::vector<TakenIndices> take_indices(Json& root) {
    const std::vector<Json*> accessors = objects_of(root, "accessors");
    const auto lacks_view = [&](const Json& index) {
        return index.is_number_unsigned() && index.get<std::uint64_t>() < accessors.size() &&
               !accessors[index.get<std::size_t>()]->contains("bufferView");
    };
    std::vector<TakenIndices> taken;
    std::size_t mesh_number = 0;
    for (Json* const mesh : objects_of(root, "meshes")) {
        std::size_t primitive_number = 0;
        for (Json* const primitive : objects_of(*mesh, "primitives")) {
            if (!is_kept(*primitive)) {
                continue;
            }
            if (primitive->contains("indices") && lacks_view((*primitive)["indices"])) {
                taken.push_back({mesh_number, primitive_number, (*primitive)["indices"].get<int>()});
                primitive->erase("indices");
            }
            ++primitive_number;
        }
        ++mesh_number;
    }
    return taken;
}

}  // namespace

JsonSurvey survey_json(std::string_view text) {
    JsonSurvey survey;
    Surveyor surveyor(text, survey);
    static_cast<void>(Json::sax_parse(text, &surveyor));
    return survey;
}

LeanJson lean_json(std::string_view json, bool is_binary, Decoders decoders) {
    LeanJson lean;
    Json root = Json::parse(json);
    if (decoders.draco) {
        drop_compressed_indices(root);
    }
    bool is_first_of_binary = is_binary;
    for (Json* const buffer : objects_of(root, "buffers")) {
        lean.buffers.push_back(take_buffer(*buffer, is_first_of_binary, decoders));
        is_first_of_binary = false;
    }
    lean.images = take_embedded_images(root);
    lean.indices = take_indices(root);
    lean.text = root.dump(-1, ' ', false, Json::error_handler_t::replace);
    return lean;
}

}  // namespace nearlight::core::gltf
