// SPDX-License-Identifier: Apache-2.0
#include "host/cli/matte_layers.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "host/base/cryptomatte_id.h"
#include "host/base/hash.h"

namespace nearlight::core {
namespace {

constexpr std::string_view kAttributes = "cryptomatte/";

/// Eight digits.
std::string hex_of_id(std::string_view name) {
    return hex_digits(std::uint64_t{cryptomatte_id(name)}).substr(8);
}

/// The numbers of names, as JSON. Bytes that are not UTF-8 are replaced.
std::string manifest_of(std::span<const std::string_view> names) {
    auto manifest = nlohmann::json::object();
    for (const std::string_view name : names) {
        manifest[std::string(name)] = hex_of_id(name);
    }
    return manifest.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::vector<MatteLayer> matte_layers(std::span<const std::string> layers) {
    std::vector<MatteLayer> wanted;
    std::ranges::copy_if(kMatteLayers, std::back_inserter(wanted), [&](const MatteLayer& layer) {
        return std::ranges::find(layers, layer.name) != layers.end();
    });
    return wanted;
}

std::vector<NamedKind> kinds_of(std::span<const MatteLayer> layers) {
    std::vector<NamedKind> kinds;
    std::ranges::transform(layers, std::back_inserter(kinds), &MatteLayer::kind);
    return kinds;
}

std::vector<FilmLayer> parts_of(std::span<const MatteLayer> layers, std::size_t first_channel) {
    std::vector<FilmLayer> parts;
    for (const MatteLayer& layer : layers) {
        for (const std::string_view part : layer.parts) {
            parts.push_back({.name = part,
                             .suffixes = "RGBA",
                             .first_channel = first_channel,
                             .channel_count = kMatteChannels / layer.parts.size(),
                             .files = FileRule::asked,
                             .storage = Storage::full});
            first_channel += parts.back().channel_count;
        }
    }
    return parts;
}

void add_matte_attributes(std::span<const MatteLayer> layers, const Scene& scene, Metadata& metadata) {
    for (const MatteLayer& layer : layers) {
        const std::string prefix = std::string(kAttributes) + hex_of_id(layer.file_name).substr(0, 7) + "/";
        metadata[prefix + "name"] = std::string(layer.file_name);
        metadata[prefix + "hash"] = std::string("MurmurHash3_32");
        metadata[prefix + "conversion"] = std::string("uint32_to_float32");
        metadata[prefix + "manifest"] = manifest_of(TriangleNames(scene, layer.kind).used());
    }
}

bool is_matte_layer(std::string_view layer, const Metadata& metadata) {
    return std::ranges::any_of(metadata, [&](const auto& attribute) {
        const auto& [key, value] = attribute;
        const auto* const name = std::get_if<std::string>(&value);
        return name != nullptr && key.starts_with(kAttributes) && key.ends_with("/name") &&
               layer.starts_with(*name);
    });
}

Metadata without_matte_attributes(Metadata metadata) {
    std::erase_if(metadata, [](const auto& attribute) { return attribute.first.starts_with(kAttributes); });
    return metadata;
}

}  // namespace nearlight::core
