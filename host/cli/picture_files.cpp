// SPDX-License-Identifier: Apache-2.0
#include "host/cli/picture_files.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>

#include "host/stages/film.h"

namespace nearlight::core {
namespace {

constexpr const char* kBeauty = "beauty";

/// "direct.R" belongs to layer "direct"; R, G and B to the beauty.
std::string layer_of(const std::string& channel) {
    const std::size_t dot = channel.find('.');
    return dot == std::string::npos ? kBeauty : channel.substr(0, dot);
}

std::set<std::string> known_layers() {
    std::set<std::string> layers;
    for (const std::string& channel : layer_channels()) {
        layers.insert(layer_of(channel));
    }
    return layers;
}

std::string extension_of(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

/// The beauty is always there, first.
std::vector<std::size_t> channels_for(const PictureOptions& options, const std::string& file) {
    const std::vector<std::string> all = layer_channels();
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string layer = layer_of(all[i]);
        const bool wanted = options.layers.empty() || std::find(options.layers.begin(), options.layers.end(),
                                                                layer) != options.layers.end();
        if (layer == kBeauty || (wanted && extension_of(file) == ".exr")) {
            chosen.push_back(i);
        }
    }
    return chosen;
}

void check_output(const std::string& file) {
    namespace fs = std::filesystem;
    if (extension_of(file) != ".exr" && extension_of(file) != ".png") {
        throw Error(ErrorKind::invalid_argument,
                    "cannot write '" + file + "': the names of pictures end in .exr or .png");
    }
    const fs::path parent = fs::path(file).parent_path();
    const fs::path folder = parent.empty() ? fs::path(".") : parent;
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
        throw Error(ErrorKind::file, "cannot write '" + file + "': there is no folder '" + folder.string() +
                                         "'; create it first");
    }
    if (fs::is_directory(file, error)) {
        throw Error(ErrorKind::file, "cannot write '" + file + "': it is a folder; give a file");
    }
    if (fs::exists(file, error) && access(file.c_str(), W_OK) != 0) {
        throw Error(ErrorKind::file,
                    "cannot write '" + file + "': it exists and is read-only; give another file");
    }
    if (access(folder.c_str(), W_OK) != 0) {
        throw Error(ErrorKind::file, "cannot write '" + file + "': the folder '" + folder.string() +
                                         "' is not writable; give another folder");
    }
}

std::vector<float> transposed(const Mat4& m) {
    std::vector<float> values;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            values.push_back(static_cast<float>(m(row, column)));
        }
    }
    return values;
}

}  // namespace

void add_picture_options(CLI::App& command, PictureOptions& options) {
    command
        .add_option("-o,--output", options.outputs,
                    "Picture to write: .exr (all layers) or .png (tone-mapped); may be given several times")
        ->type_name("OUT")
        ->allow_extra_args(false)
        ->required();
    command
        .add_option("--layers,--aov", options.layers,
                    "Layers of EXR pictures besides beauty, comma-separated (default: all): direct, "
                    "indirect, albedo, N, P, depth, closerange")
        ->type_name("LIST")
        ->delimiter(',')
        ->allow_extra_args(false);
    command.add_option("--exposure", options.exposure, "Exposure of PNG pictures, in stops")
        ->type_name("EV")
        ->capture_default_str();
}

void check_outputs(const PictureOptions& options) {
    const std::set<std::string> known = known_layers();
    for (const std::string& layer : options.layers) {
        if (!known.contains(layer)) {
            std::string list;
            for (const std::string& name : known) {
                list += (list.empty() ? "" : ", ") + name;
            }
            throw Error(ErrorKind::invalid_argument, "unknown layer '" + layer + "'; choose from: " + list);
        }
    }
    for (const std::string& file : options.outputs) {
        check_output(file);
    }
}

Metadata camera_metadata(const SceneCamera& camera) {
    const Mat4 world_to_camera = inverse(camera.to_world);
    const double tan_x = std::tan(camera.fov_x_degrees * std::numbers::pi / 360.0);
    const double tan_y = tan_x * camera.height / camera.width;
    // NDC: x and y in [0, 1] from the top left corner after division by w = z. The camera's +X points left.
    Mat4 projection{{-0.5 / tan_x, 0, 0.5, 0, 0, -0.5 / tan_y, 0.5, 0, 0, 0, 1, 0, 0, 0, 1, 0}};
    return {{"worldToCamera", transposed(world_to_camera)},
            {"worldToNDC", transposed(projection * world_to_camera)}};
}

void PictureFiles::open(int width, int height, const Metadata& metadata) {
    const std::vector<std::string> all = layer_channels();
    ImageWriterOptions writer_options{metadata, options_.exposure};
    writer_options.metadata["renderTimeSeconds"] = 0.0f;
    for (const std::string& file : options_.outputs) {
        std::vector<std::size_t> channels = channels_for(options_, file);
        std::vector<std::string> names;
        for (const std::size_t channel : channels) {
            names.push_back(all[channel]);
        }
        files_.push_back(
            {ImageWriter(file, width, height, std::move(names), writer_options), std::move(channels)});
    }
}

void PictureFiles::write_rows(std::span<const float> rows) {
    constexpr std::size_t kChannels = NEARLIGHT_LAYER_CHANNELS;
    const std::size_t pixel_count = rows.size() / kChannels;
    for (File& file : files_) {
        selected_.clear();
        selected_.reserve(pixel_count * file.channels.size());
        for (std::size_t pixel = 0; pixel < pixel_count; ++pixel) {
            for (const std::size_t channel : file.channels) {
                selected_.push_back(rows[pixel * kChannels + channel]);
            }
        }
        file.writer.write_rows(selected_);
    }
}

void PictureFiles::commit(double render_seconds) {
    for (File& file : files_) {
        file.writer.commit({{"renderTimeSeconds", static_cast<float>(render_seconds)}});
    }
}

}  // namespace nearlight::core
