// SPDX-License-Identifier: Apache-2.0
#include "host/cli/diff_command.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "host/cli/log.h"
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
};

struct LayerDifference {
    std::string layer;  ///< empty: the picture itself
    ImageDifference difference;
};

/// What `nearlight render` calls the picture itself.
constexpr const char* kBeauty = "beauty";

std::string name_of(const std::string& layer) {
    return layer.empty() ? "(picture)" : layer;
}

/// The layers that the options name, or else all layers that both pictures have.
std::vector<std::string> layers_to_compare(const DiffOptions& options, const Image& a, const Image& b) {
    if (!options.layers.empty()) {
        std::vector<std::string> layers = options.layers;
        std::ranges::replace(layers, std::string(kBeauty), std::string());
        return layers;
    }
    std::vector<std::string> layers;
    for (const std::string& layer : color_layers(a)) {
        if (has_color_layer(b, layer)) {
            layers.push_back(layer);
        }
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
        layers.push_back({{"layer", layer},
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
        text += fmt::format("{:<16} {:>12.5g} {:>12.5g} {:>12} {:>12} {:>12}\n", name_of(layer),
                            difference.rmse, difference.relative_mse, fixed_text(difference.mean_ratio, 6),
                            fixed_text(difference.flip, 5), difference.non_finite);
    }
    return text;
}

ExitCode run_diff(const DiffOptions& options, const GlobalOptions& global) {
    if (!options.map.empty()) {
        check_writable(options.map.string());
    }
    const Image a = read_linear_image(options.image);
    const Image b = read_linear_image(options.reference);
    if (a.width != b.width || a.height != b.height) {
        throw Error(
            ErrorKind::file,
            fmt::format("'{}' has {}x{} pixels, but '{}' has {}x{}; give two pictures of the same size",
                        options.image.string(), a.width, a.height, options.reference.string(), b.width,
                        b.height));
    }
    const std::vector<std::string> layers = layers_to_compare(options, a, b);
    std::vector<LayerDifference> differences;
    for (const std::string& layer : layers) {
        differences.push_back({layer, compare_images(a, b, layer)});
    }
    if (!options.map.empty()) {
        write_image(options.map, flip_map(a, b, layers.front()));
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
        .add_option("--layer", options->layers,
                    "Compare only this layer, such as direct, N or depth; may be given several times")
        ->type_name("NAME")
        ->allow_extra_args(false);
}

}  // namespace nearlight::core
