// SPDX-License-Identifier: Apache-2.0
// Layers of Cryptomatte, which `render --layers` can ask for.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/image/image_io.h"
#include "host/scene/scene_names.h"
#include "host/session/mattes.h"
#include "host/stages/film_layers.h"

namespace nearlight::core {

/// A set of mattes. Its EXR layers are FILE_NAME00 to FILE_NAME02, with two ranks each.
struct MatteLayer {
    std::string_view name;       ///< for --layers
    std::string_view file_name;  ///< by the convention of other renderers
    NamedKind kind;
    std::array<std::string_view, kMatteRanks / 2> parts;
};
inline constexpr std::array kMatteLayers{
    MatteLayer{"cryptomatte_object",
               "CryptoObject",
               NamedKind::object,
               {"CryptoObject00", "CryptoObject01", "CryptoObject02"}},
    MatteLayer{"cryptomatte_material",
               "CryptoMaterial",
               NamedKind::material,
               {"CryptoMaterial00", "CryptoMaterial01", "CryptoMaterial02"}}};

/// Those of the layers that are mattes, in the order of kMatteLayers.
std::vector<MatteLayer> matte_layers(std::span<const std::string> layers);
std::vector<NamedKind> kinds_of(std::span<const MatteLayer> layers);

/// The layers of files, in rows where they stand from `first_channel` on.
std::vector<FilmLayer> parts_of(std::span<const MatteLayer> layers, std::size_t first_channel);

/// Adds the attributes by which files say what the numbers of mattes stand for.
void add_matte_attributes(std::span<const MatteLayer> layers, const Scene& scene, Metadata& metadata);
/// Whether a layer of a file holds mattes, by the attributes of the file. Any program may have written it.
bool is_matte_layer(std::string_view layer, const Metadata& metadata);
/// Without those attributes, for files that have no mattes.
Metadata without_matte_attributes(Metadata metadata);

}  // namespace nearlight::core
