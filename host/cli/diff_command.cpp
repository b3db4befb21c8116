// SPDX-License-Identifier: Apache-2.0
#include "host/cli/diff_command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/base/words.h"
#include "host/cli/log.h"
#include "host/cli/matte_layers.h"
#include "host/cli/output.h"
#include "host/cli/picture_files.h"
#include "host/compare/number_text.h"
#include "host/image/image_io.h"
#include "host/image/metrics.h"

namespace nearlight::core {
namespace {

struct DiffOptions {
    std::filesystem::path image;
    std::filesystem::path reference;
    std::filesystem::path map;
    std::vector<std::string> layers;  ///< empty: all that both files have
    float exposure = 0.0f;            ///< stops, for FLIP
};

struct LayerDifference {
    std::string layer;  ///< empty: the beauty
    ImageDifference difference;
};

/// What `nearlight render` calls the channels R, G and B without a name.
constexpr const char* kBeauty = "beauty";
/// The channel of pictures of greys.
constexpr const char* kGrey = "Y";

std::string name_of(const std::string& layer) {
    return layer.empty() ? kBeauty : layer;
}

/// Throws Error(ErrorKind::file) if the picture of a file lacks one of the layers.
void check_layers(const Image& image, const std::filesystem::path& file,
                  const std::vector<std::string>& layers) {
    const std::vector<std::string> known = layer_names(image.channels);
    for (const std::string& layer : layers) {
        if (std::ranges::find(known, name_of(layer)) == known.end()) {
            throw Error(ErrorKind::file, fmt::format("'{}' has no layer '{}'; it has {}", file.string(),
                                                     name_of(layer), joined(known, ", ")));
        }
    }
}

/// The layers that the options name, or else all layers of colours that both pictures have. A picture of
/// greys is one layer, Y.
std::vector<std::string> layers_to_compare(const DiffOptions& options, const Image& a, const Image& b) {
    if (!options.layers.empty()) {
        std::vector<std::string> layers = options.layers;
        std::ranges::replace(layers, std::string(kBeauty), std::string());
        return layers;
    }
    const std::vector<std::string> colors = color_layers(a);
    const Metadata metadata = colors.size() > 1 ? read_metadata(options.image) : Metadata();
    std::vector<std::string> layers;
    for (const std::string& layer : colors) {
        if (has_color_layer(b, layer) && !is_matte_layer(layer, metadata)) {
            layers.push_back(layer);
        }
    }
    if (layers.empty() && a.find_channel(kGrey) >= 0 && b.find_channel(kGrey) >= 0) {
        layers.emplace_back(kGrey);
    }
    if (layers.empty()) {
        throw Error(ErrorKind::file, "'" + options.image.string() + "' and '" + options.reference.string() +
                                         "' have no RGB layer in common");
    }
    return layers;
}

nlohmann::ordered_json to_json(const DiffOptions& options, const Image& a,
                               const std::vector<LayerDifference>& differences) {
    nlohmann::ordered_json layers = nlohmann::ordered_json::array();
    for (const auto& [layer, difference] : differences) {
        layers.push_back({{"layer", name_of(layer)},
                          {"rmse", difference.rmse},
                          {"relative_mse", difference.relative_mse},
                          {"mean_ratio", difference.mean_ratio},
                          {"flip", difference.flip},
                          {"non_finite", difference.non_finite}});
    }
    return {{"image", options.image.string()},
            {"reference", options.reference.string()},
            {"width", a.width},
            {"height", a.height},
            {"layers", layers}};
}

std::string to_table(const std::vector<LayerDifference>& differences) {
    std::string text = fmt::format("{:<16} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "layer", "RMSE",
                                   "relative MSE", "mean ratio", "FLIP", "not finite");
    for (const auto& [layer, difference] : differences) {
        text += fmt::format("{:<16} {:>12} {:>12} {:>12} {:>12} {:>12}\n", name_of(layer),
                            number_text(difference.rmse, 5), number_text(difference.relative_mse, 5),
                            fixed_text(difference.mean_ratio, 6), fixed_text(difference.flip, 5),
                            difference.non_finite);
    }
    return text;
}

void check_map(const DiffOptions& options) {
    check_writable(options.map.string());
    for (const std::filesystem::path& picture : {options.image, options.reference}) {
        std::error_code ignored;
        if (std::filesystem::equivalent(options.map, picture, ignored)) {
            throw Error(ErrorKind::invalid_argument,
                        fmt::format("the map would replace the picture '{}'; give another name to -o",
                                    picture.string()));
        }
    }
}

/// The size of a picture and its place in a larger one, as --crop takes them.
std::string extent_of(const Image& image) {
    const std::string size = fmt::format("{}x{}", image.width, image.height);
    return image.place ? fmt::format("{}+{}+{} of {}x{}", size, image.place->x, image.place->y,
                                     image.place->whole_width, image.place->whole_height)
                       : size;
}

/// Cuts the part of a whole picture that another one shows.
void cut_to(const Image& part, Image& whole) {
    const std::optional<ImagePlace>& place = part.place;
    const bool is_inside = place && place->x >= 0 && place->y >= 0 && place->x + part.width <= whole.width &&
                           place->y + part.height <= whole.height;
    if (is_inside && !whole.place && place->whole_width == whole.width &&
        place->whole_height == whole.height) {
        whole = part_of(whole, place->x, place->y, part.width, part.height);
    }
}

/// Warns where FLIP is blind.
void warn_of_white(const Image& reference, const std::string& layer, float scale) {
    constexpr double kMaxWhite = 0.1;
    const int green = reference.find_channel(layer.empty() ? "G" : layer + ".G");
    std::size_t white = 0;
    for (std::size_t i = 0; green >= 0 && i < reference.pixel_count(); ++i) {
        const float value = reference.values[i * reference.channel_count() + static_cast<std::size_t>(green)];
        white += value * scale > 1.0f ? 1 : 0;
    }
    const double part = static_cast<double>(white) / static_cast<double>(reference.pixel_count());
    if (part > kMaxWhite) {
        spdlog::warn(
            "{:.0f} % of the reference is above 1, where FLIP sees no difference; --exposure, which may "
            "be negative, shows it darker",
            100 * part);
    }
}

ExitCode run_diff(const DiffOptions& options, const GlobalOptions& global) {
    if (!options.map.empty()) {
        check_map(options);
    }
    Image a = read_linear_image(options.image);
    Image b = read_linear_image(options.reference);
    cut_to(a, b);
    cut_to(b, a);
    // A PNG file of a part does not say which part it is.
    const bool are_elsewhere = a.place && b.place && a.place != b.place;
    if (a.width != b.width || a.height != b.height || are_elsewhere) {
        throw Error(
            ErrorKind::file,
            fmt::format("'{}' has the pixels {}, but '{}' has {}; give two pictures of the same pixels",
                        options.image.string(), extent_of(a), options.reference.string(), extent_of(b)));
    }
    const float scale = std::exp2(options.exposure);
    const std::vector<std::string> layers = layers_to_compare(options, a, b);
    check_layers(a, options.image, layers);
    check_layers(b, options.reference, layers);
    std::vector<LayerDifference> differences;
    for (const std::string& layer : layers) {
        differences.push_back({layer, compare_images(a, b, layer, scale)});
    }
    warn_of_white(b, layers.front(), scale);
    if (!options.map.empty()) {
        write_image(options.map, flip_map(a, b, layers.front(), scale));
        spdlog::info("wrote {}", options.map.string());
    }
    if (global.json) {
        print_json(to_json(options, a, differences));
    } else {
        print(to_table(differences));
    }
    return ExitCode::done;
}

}  // namespace

void add_diff_command(CommandLine& line) {
    auto options = std::make_shared<DiffOptions>();
    CLI::App& command =
        line.add_command("diff", "Compare two pictures by RMSE, relative MSE, mean ratio and FLIP",
                         [options](const GlobalOptions& global) { return run_diff(*options, global); });
    command.add_option("A", options->image, "Picture to judge")->required();
    command.add_option("B", options->reference, "Reference picture of the same size")->required();
    command
        .add_option("-o,--output", options->map,
                    "Write a map of the FLIP error of the first layer to this file")
        ->type_name("MAP");
    command
        .add_option("--exposure", options->exposure,
                    "Stops by which FLIP sees both pictures brighter; it takes what is above 1 for white")
        ->check(number_from(-100.0, 100.0))
        ->type_name("STOPS");
    command
        .add_option("--layer", options->layers,
                    "Compare only this layer, such as direct, N or depth; may be given several times")
        ->type_name("NAME")
        ->allow_extra_args(false);
}

}  // namespace nearlight::core
